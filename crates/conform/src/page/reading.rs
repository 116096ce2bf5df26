//! How to read the page, and what to look at first where a program differs.

use super::{Program, mark};
use crate::rules::{BRIGHTEST, Rules};
use crate::tile::TILES;
use maud::{Markup, html};

/// What verdicts, δ and error rates mean.
pub(super) fn legend(programs: &[Program<'_>]) -> Markup {
    let rules = Rules::new(0, 0, 0, 0.0);
    let mut bounds: Vec<String> = (programs.iter())
        .map(|program| format!("{} %", 100.0 * program.run.report.plan.bound))
        .collect();
    bounds.dedup();
    let bound = bounds.join(", ");
    html! {
        details class="about" {
            summary { "How to read this: verdicts, δ, error rates" }
            p { "Each question is a small scene whose picture is known in closed form. The program renders it many times, each time with "
                "another seed or in another pose (turned, grown, moved). The unit is one picture: the means of all pictures, and of "
                (TILES) " × " (TILES) " tiles, are compared with the truth's. Nothing is asked to be equal: a sound program may have a bias that "
                "vanishes with more samples." }
            dl class="facts" {
                dt { "δ" } dd { "How far the mean may be off, relative to the truth's: " (bound) "." }
                dt { (mark("agrees")) } dd { "The interval of the mean lies within ± δ, and no tile is shown to be off by more than "
                    (100.0 * rules.tile_bound) " % of its mean (and δ of the picture's)." }
                dt { (mark("differs")) } dd { "The mean or a tile is shown to be beyond that. First suspect the driver." }
                dt { (mark("undecided")) } dd { "Neither is shown; more pictures or samples would tell. This is never a pass." }
                dt { (mark("not supported")) } dd { "The program cannot express the scene, and says so. This counts neither way." }
                dt { (mark("broken")) } dd { "There are no pictures that could be judged: an error, a wrong size, copies in place of replicates." }
                dt { "Interval of 95 %" } dd { "That of one question by itself: about one in twenty misses its truth. It is for the eye, and decides nothing." }
                dt { "Level of the run" } dd { "The intervals that decide are wider, so that they hold for all questions together: the probability that any of "
                    "them misses in a run is 1 in " (format!("{:.0}", 1.0 / rules.miss)) ", and that a sound program is accused of anything 1 in "
                    (format!("{:.0}", 1.0 / rules.alarm)) "." }
                dt { "Too dark" } dd { "A rare bright sample may be to come. So this is said only where what is missing would have come by now in samples of at most "
                    (BRIGHTEST) " times the brightest pixel, or of a light's radiance for a program that finds lights by chance." }
                dt { "4 × the samples" } dd { "A wrong formula stays wrong with more samples; what a sound but biased method adds falls. "
                    "This tells, and decides nothing." }
                dt { "Exit codes" } dd { "0 agrees in all that it can express, 1 differs, 2 something is broken, 3 something is undecided." }
            }
        }
    }
}

/// What to look at before a renderer is blamed.
pub(super) fn checklist(open: bool) -> Markup {
    let calibration = ["wall", "point-light-unit", "sun-unit", "sphere-light-small"];
    html! {
        details class="about" open=[open.then_some("open")] {
            summary { "It differs: the driver, or the renderer?" }
            p { "Most first differences are the driver's. In this order:" }
            ol class="checklist" {
                li { strong { "Units first. " } "Do " @for (index, name) in calibration.iter().enumerate() {
                        @if index > 0 { ", " } code { (name) }
                    } " agree? If one differs, a unit is wrong: nothing else can be read before that." }
                li { strong { "The film next. " } "Does " code { "registration" } " agree? A film that is off by a pixel shifts every picture, and many questions differ a "
                    "little for that one reason." }
                li { strong { "One pose, or all? " } "See the dots of a question. A difference in one pose only has to do with orientation, handedness, size or "
                    "position: see first how the driver turns cameras and objects." }
                li { strong { "Does it grow or shrink with samples? " } "What vanishes with more samples is a bias that the program may have. What stays, and is "
                    "shown more clearly with more pictures, is not." }
                li { strong { "Does a factor or a flip explain it? " } "See “looks like”: π, 2, 683, upside down, rows for columns. Declare a factor with its reason; never "
                    "fit one to an answer." }
                li { strong { "Another variant of the program? " } "Another precision, back end, integrator or release that agrees says where to look." }
                li { strong { "The exact scene by hand. " } "Open the scene file of the question, write it in the program's own format, and render it without the driver. "
                    "If that differs too, the renderer's authors want to know; the scene, the formula and the command below are what they need." }
            }
        }
    }
}
