//! Has a program render jobs, several at a time, each within a time.

use crate::driver::Driver;
use crate::job::Job;
use crate::mode::Mode;
use crate::scene_format::{self, SceneFormat};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// What became of a job.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// There is a picture.
    Rendered,
    /// The program cannot express the scene: why.
    Unsupported(String),
    /// It failed: how.
    Broken(String),
}

/// How jobs are run.
pub struct Runner<'a> {
    /// Jobs at a time, each with one thread.
    pub workers: usize,
    /// The longest that a job may take.
    pub limit: Duration,
    /// Called when a job has ended.
    pub done: &'a (dyn Fn(&Job, &Outcome) + Sync),
    /// Set when no more jobs are to be begun.
    pub stop: &'a AtomicBool,
}

/// Where scenes and pictures are (an absolute path), the seed of their poses, and what the program is to leave out.
#[derive(Clone, Copy)]
pub(crate) struct Place<'a> {
    pub(crate) folder: &'a Path,
    pub(crate) suite_seed: u64,
    pub(crate) mode: Mode,
}

impl Place<'_> {
    fn values(&self, job: &Job) -> BTreeMap<&'static str, String> {
        job.values(self.folder, 1, self.mode)
    }

    /// What a language cannot say of a question.
    fn why_it_is_missing(&self, format: &SceneFormat, job: &Job) -> String {
        let question = crate::questions::by_name(&job.question);
        let why = question.and_then(|question| {
            let (scene, _) = question.posed(self.suite_seed, job.pose);
            (format.write)(&scene, question.name, self.mode).err()
        });
        why.unwrap_or_else(|| format!("its {} file is missing", format.ending))
    }

    /// The command for a job, or why there is none.
    fn command(&self, driver: &Driver, job: &Job) -> Result<Vec<String>, Outcome> {
        let values = self.values(job);
        let words = &driver.description.command;
        for format in &scene_format::ALL {
            let placeholder = format!("{{{}}}", format.ending);
            let is_asked = words.iter().any(|word| word.contains(&placeholder));
            if is_asked && !Path::new(&values[format.ending]).is_file() {
                return Err(Outcome::Unsupported(self.why_it_is_missing(format, job)));
            }
        }
        driver.command(&values).map_err(Outcome::Broken)
    }
}

impl Runner<'_> {
    /// Runs the jobs; what became of each, in their order. Jobs that were not begun are missing: after a stop, and those of a question
    /// of which one could not be rendered.
    pub(crate) fn run(
        &self,
        driver: &Driver,
        jobs: &[Job],
        place: Place<'_>,
    ) -> Vec<(Job, Outcome)> {
        let next = Mutex::new(0..jobs.len());
        let given_up = Mutex::new(BTreeSet::new());
        let take = || {
            let mut next = locked(&next);
            (!self.stop.load(Ordering::Relaxed))
                .then(|| next.find(|index| !locked(&given_up).contains(&jobs[*index].question)))
                .flatten()
        };
        let work = || {
            let mut own = Vec::new();
            let mut batch: Option<Batch> = None;
            while let Some(index) = take() {
                let job = &jobs[index];
                let picture = job.picture(place.folder);
                let outcome = match driver.description.batch {
                    true => self.in_batch(driver, &mut batch, job, place),
                    false => self.alone(driver, job, place),
                };
                let outcome = match outcome {
                    Outcome::Rendered if !picture.is_file() => {
                        Outcome::Broken("it wrote no picture".to_owned())
                    }
                    outcome => outcome,
                };
                if outcome != Outcome::Rendered {
                    // Half a picture must not be taken for one by a later run.
                    let _ = std::fs::remove_file(picture);
                    locked(&given_up).insert(job.question.clone());
                }
                (self.done)(job, &outcome);
                own.push((index, job.clone(), outcome));
            }
            own
        };
        let mut all: Vec<_> = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..self.workers.max(1))
                .map(|_| scope.spawn(work))
                .collect();
            let ended = workers.into_iter().map(|worker| worker.join());
            ended.flat_map(|own| own.unwrap_or_default()).collect()
        });
        all.sort_by_key(|(index, ..)| *index);
        all.into_iter()
            .map(|(_, job, outcome)| (job, outcome))
            .collect()
    }

    /// A program that renders one picture and ends.
    fn alone(&self, driver: &Driver, job: &Job, place: Place<'_>) -> Outcome {
        let child = place
            .command(driver, job)
            .and_then(|words| start(&words, Stdio::null(), Stdio::null()).map_err(Outcome::Broken));
        let mut child = match child {
            Ok(child) => child,
            Err(outcome) => return outcome,
        };
        let said = child.stderr.take().map(listen);
        let begin = Instant::now();
        let status = loop {
            match child.try_wait() {
                Ok(Some(status)) => break status,
                Ok(None) if begin.elapsed() < self.limit => {
                    std::thread::sleep(Duration::from_millis(2));
                }
                Ok(None) => {
                    end(&mut child);
                    return too_slow(self.limit);
                }
                Err(error) => return Outcome::Broken(error.to_string()),
            }
        };
        let said = said.and_then(|said| said.recv().ok()).unwrap_or_default();
        match status.code() {
            Some(0) => Outcome::Rendered,
            Some(3) => Outcome::Unsupported(last_line(&said)),
            _ => Outcome::Broken(format!("{status}: {}", last_line(&said))),
        }
    }

    /// A program that goes on to the next job.
    fn in_batch(
        &self,
        driver: &Driver,
        batch: &mut Option<Batch>,
        job: &Job,
        place: Place<'_>,
    ) -> Outcome {
        let running = match batch.take().map_or_else(|| Batch::start(driver), Ok) {
            Ok(running) => batch.insert(running),
            Err(message) => return Outcome::Broken(message),
        };
        let mut line = serde_json::to_value(place.values(job)).expect("words");
        for (name, value) in [("samples", job.samples), ("seed", job.seed), ("threads", 1)] {
            line[name] = value.into();
        }
        match running.ask(&line.to_string(), self.limit) {
            Ok(Answer::Rendered { .. }) => Outcome::Rendered,
            Ok(Answer::Unsupported { unsupported }) => Outcome::Unsupported(unsupported),
            Ok(Answer::Error { error }) => Outcome::Broken(error),
            Err(outcome) => {
                // The next job begins with another process.
                *batch = None;
                outcome
            }
        }
    }
}

/// What a worker that has panicked left behind is whole all the same.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Starts a program, whose standard error is kept.
fn start(words: &[String], input: Stdio, output: Stdio) -> Result<Child, String> {
    let [program, arguments @ ..] = words else {
        return Err("the command has no words".to_owned());
    };
    Command::new(program)
        .args(arguments)
        .stdin(input)
        .stdout(output)
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| format!("{program}: {error}"))
}

/// Reads all that a program says, in a thread of its own, so that it never waits for a reader.
fn listen(stream: impl Read + Send + 'static) -> Receiver<String> {
    let (say, hear) = channel();
    std::thread::spawn(move || {
        let mut text = Vec::new();
        let _ = BufReader::new(stream).read_to_end(&mut text);
        let _ = say.send(String::from_utf8_lossy(&text).into_owned());
    });
    hear
}

/// The last line of what was said.
fn last_line(said: &str) -> String {
    let line = said
        .trim()
        .lines()
        .last()
        .unwrap_or("it says nothing on standard error");
    line.to_owned()
}

fn too_slow(limit: Duration) -> Outcome {
    Outcome::Broken(format!("it took longer than {} s", limit.as_secs()))
}

fn end(child: &mut Child) {
    let _ = child.kill();
    let _ = child.wait();
}

/// A program that reads jobs.
struct Batch {
    child: Child,
    jobs: ChildStdin,
    answers: Receiver<String>,
    said: Receiver<String>,
}

impl Drop for Batch {
    fn drop(&mut self) {
        end(&mut self.child);
    }
}

/// An answer.
#[derive(Deserialize)]
#[serde(untagged)]
enum Answer {
    Unsupported {
        unsupported: String,
    },
    Error {
        error: String,
    },
    Rendered {
        #[serde(rename = "out")]
        _out: String,
    },
}

impl Batch {
    fn start(driver: &Driver) -> Result<Self, String> {
        let words = driver.command(&BTreeMap::new())?;
        let mut child = start(&words, Stdio::piped(), Stdio::piped())?;
        let streams = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let (Some(jobs), Some(output), Some(errors)) = streams else {
            return Err("its standard input and output cannot be had".to_owned());
        };
        let (say, answers) = channel();
        std::thread::spawn(move || {
            let lines = BufReader::new(output).lines().map_while(Result::ok);
            for line in lines {
                if say.send(line).is_err() {
                    break;
                }
            }
        });
        Ok(Self {
            child,
            jobs,
            answers,
            said: listen(errors),
        })
    }

    /// The answer to a job; an error of the program itself, which has ended then.
    fn ask(&mut self, line: &str, limit: Duration) -> Result<Answer, Outcome> {
        let broken = |message: String| Outcome::Broken(message);
        let written = writeln!(self.jobs, "{line}").and_then(|()| self.jobs.flush());
        let answer = match written {
            Ok(()) => self.answers.recv_timeout(limit),
            Err(_) => Err(RecvTimeoutError::Disconnected),
        };
        match answer {
            Ok(answer) => serde_json::from_str(&answer)
                .map_err(|_| broken(format!("it answers `{answer}`, which is no answer"))),
            Err(RecvTimeoutError::Timeout) => Err(too_slow(limit)),
            Err(RecvTimeoutError::Disconnected) => {
                let said = self.said.recv_timeout(Duration::from_secs(5));
                let said = last_line(&said.unwrap_or_default());
                Err(broken(format!("it ended: {said}")))
            }
        }
    }
}
