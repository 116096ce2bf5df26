//! The command that draws a sample again.

use super::options;
use crate::args::RenderArgs;
use crate::quoting;
use etalon_integrators::RenderPlan;

/// The command that replays sample `sample` of a pixel in a replicate of this render; `pilot` is
/// the size of the pilot that dealt the samples, if they were not dealt evenly.
pub(super) fn command(
    args: &RenderArgs,
    plan: &RenderPlan,
    pilot: Option<u32>,
    [x, y]: [i32; 2],
    replicate: u32,
    sample: u32,
) -> String {
    let mut words = vec![
        "etalon render".to_owned(),
        quoting::shell(&args.scene.display().to_string()),
    ];
    words.extend(options::of_the_picture(args));
    if let Some(frame) = args.frame {
        words.push(format!("--frames {} --fps {}", frame.number, args.fps));
    }
    words.extend(options::of_the_scene(args));
    let spp = u64::from(plan.replicates) * u64::from(plan.samples_per_replicate);
    words.push(format!(
        "--spp {spp} --replicates {} --seed {}",
        plan.replicates, plan.seed
    ));
    let independent = args.independent_replicates;
    words.extend(independent.then(|| "--independent-replicates".to_owned()));
    words.extend(pilot.map(|pilot| format!("--adaptive --pilot {pilot}")));
    words.push(format!("--replay {x},{y},{replicate},{sample}"));
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{Cli, Command};
    use clap::Parser;
    use etalon_sampling::{ReplicateKind, SamplerKind};

    /// The command draws the same sample for any defaults of the scene.
    #[test]
    fn the_command_says_all_that_decides_the_sample() {
        let said = "etalon render scene.xml -o a.exr --integrator path --light-chooser tree \
                    --scale 50% --crop 8,4,16,16 --sensor top -D colour=1,2 -D name=a'b";
        let parsed = Cli::try_parse_from(said.split(' ')).expect("a valid command line");
        let Command::Render(args) = parsed.command else {
            panic!("it renders");
        };
        let plan = RenderPlan {
            seed: 7,
            replicates: 4,
            replicate_kind: ReplicateKind::Independent,
            share: None,
            samples_per_replicate: 8,
            sampler: SamplerKind::Sobol,
        };
        let expected = "etalon render scene.xml --integrator path --light-chooser tree \
                        --scale 0.5 --crop 8,4,16,16 --sensor top -D colour=1,2 -D \"name=a'b\" --spp 32 --replicates 4 --seed 7 \
                        --replay 12,5,2,3";
        assert_eq!(command(&args, &plan, None, [12, 5], 2, 3), expected);
        let dealt = expected.replace("--replay", "--adaptive --pilot 64 --replay");
        assert_eq!(command(&args, &plan, Some(64), [12, 5], 2, 3), dealt);
        let args = RenderArgs {
            independent_replicates: true,
            ..args
        };
        let independent = expected.replace("--replay", "--independent-replicates --replay");
        assert_eq!(command(&args, &plan, None, [12, 5], 2, 3), independent);
    }
}
