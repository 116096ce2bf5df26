//! Job files for the existing engine of a cluster: nothing here starts a daemon or opens a socket.
//!
//! A task is one command, `sh task.sh N`: it renders a part of the replicates, or a frame, with `--resume`, so that any
//! engine may start it again at any time. `sh merge.sh` merges the parts, and `sh submit.sh` submits both to the engine.

use crate::quoting;
use std::collections::HashSet;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// The most tasks of one array job: Slurm's `MaxArraySize` is 1001 unless a site says otherwise.
const MOST_TASKS: u32 = 1000;

/// Who runs the tasks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Engine {
    /// An array job, and a merge that waits for it.
    Slurm,
    /// A job template of Open Job Description (AWS Deadline Cloud and others).
    Openjd,
    /// GNU parallel, on one machine or by ssh on several.
    Parallel,
}

/// What a task renders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// One of so many parts of a picture.
    Parts(u32),
    /// A frame of an animation, by its number.
    Frames {
        /// The first.
        first: u32,
        /// The last.
        last: u32,
    },
}

impl Work {
    /// The number of the first piece and of the last.
    fn range(self) -> [u32; 2] {
        match self {
            Self::Parts(count) => [1, count],
            Self::Frames { first, last } => [first, last],
        }
    }

    /// How many pieces there are.
    pub fn count(self) -> u32 {
        let [first, last] = self.range();
        last - first + 1
    }
}

/// A render for a cluster.
#[derive(Clone, Debug)]
pub struct Job {
    /// The engine.
    pub engine: Engine,
    /// What there is to do.
    pub work: Work,
    /// What people call it: the scene's name.
    pub name: String,
    /// The program, as the cluster sees it.
    pub program: PathBuf,
    /// The scene.
    pub scene: PathBuf,
    /// Where everything goes.
    pub folder: PathBuf,
    /// The options of `etalon render`, quoted for a shell.
    pub options: String,
}

/// A path for a shell.
fn quoted(path: &Path) -> String {
    quoting::shell(&path.display().to_string())
}

impl Job {
    fn inside(&self, name: &str) -> String {
        quoted(&self.folder.join(name))
    }

    /// The folder of the pieces, and the name of the piece `number`.
    fn pieces(&self, number: &str) -> (&'static str, String) {
        match self.work {
            Work::Parts(_) => ("parts", format!("part-{number}.exr")),
            Work::Frames { .. } => ("frames", format!("{}.{number}.exr", self.name)),
        }
    }

    /// Files, of these names, in the folder of the pieces, that are pictures of another job.
    pub fn stale<'a>(&self, names: &'a [String]) -> Vec<&'a str> {
        let [first, last] = self.work.range();
        let ours: HashSet<String> = (first..=last)
            .map(|n| self.pieces(&format!("{n:04}")).1)
            .collect();
        let names = names.iter().map(String::as_str);
        names
            .filter(|name| {
                name.ends_with(".exr") && !name.starts_with('.') && !ours.contains(*name)
            })
            .collect()
    }

    /// The folder of the pieces.
    pub fn pieces_folder(&self) -> &'static str {
        self.pieces("").0
    }

    /// How many tasks there are; each has every so many-th piece.
    fn tasks(&self) -> u32 {
        self.work.count().min(MOST_TASKS)
    }

    /// The files, by name.
    pub fn files(&self) -> Vec<(&'static str, String)> {
        let mut files = vec![
            ("task.sh", self.task()),
            ("merge.sh", self.merge()),
            ("submit.sh", self.submit()),
        ];
        match self.engine {
            Engine::Slurm => files.push(("render.slurm", self.slurm())),
            Engine::Openjd => files.push(("template.yaml", self.template())),
            Engine::Parallel => {}
        }
        files
    }

    fn task(&self) -> String {
        let [first, last] = self.work.range();
        let (tasks, program, scene) = (self.tasks(), quoted(&self.program), quoted(&self.scene));
        let (folder, frame) = self.pieces("####");
        let piece = match self.work {
            Work::Parts(count) => format!(
                "-o {}/part-$(printf %04d \"$piece\").exr --part \"$piece\"/{count}",
                self.inside(folder)
            ),
            Work::Frames { .. } => {
                let frame = self.inside(&format!("{folder}/{frame}"));
                format!("-o {frame} --frames \"$piece\"")
            }
        };
        let last_task = first + tasks - 1;
        format!(
            "#!/bin/sh\n\
             # sh task.sh N: renders piece N, and every {tasks}th after it, of {first} to {last} (N from {first} to {last_task}). A piece that is\n\
             # finished is verified and left alone, one that was begun goes on from its checkpoint.\n\
             set -eu\n\
             etalon=${{ETALON:-{program}}}\n\
             piece=$1\n\
             while [ \"$piece\" -le {last} ]; do\n    \
                 \"$etalon\" render {scene} {piece} --resume -q{options}\n    \
                 piece=$((piece + {tasks}))\n\
             done\n",
            options = self.options
        )
    }

    fn merge(&self) -> String {
        let program = quoted(&self.program);
        let image = self.folder.join(&self.name);
        let (folder, frame) = self.pieces("####");
        // What else may lie in the folders is of other jobs.
        let commands = match self.work {
            Work::Parts(count) => format!(
                "for piece in $(seq 1 {count}); do\n    \
                     set -- \"$@\" {}/part-$(printf %04d \"$piece\").exr\n\
                 done\n\
                 \"$etalon\" merge \"$@\" -o {image}\n\"$etalon\" convert {image} {picture}\n",
                self.inside(folder),
                image = quoted(&image.with_extension("exr")),
                picture = quoted(&image.with_extension("png"))
            ),
            Work::Frames { first, last } => format!(
                "\"$etalon\" movie {} --frames {first}..{last} -o {}\n",
                self.inside(&format!("{folder}/{frame}")),
                quoted(&image.with_extension("png"))
            ),
        };
        format!(
            "#!/bin/sh\n# Puts together what the tasks have rendered.\nset -eu\nset --\netalon=${{ETALON:-{program}}}\n{commands}"
        )
    }

    /// From the first task to the last.
    fn span(&self) -> [u32; 2] {
        let [first, _] = self.work.range();
        [first, first + self.tasks() - 1]
    }

    fn submit(&self) -> String {
        let [first, last] = self.span();
        let (task, merge) = (self.inside("task.sh"), self.inside("merge.sh"));
        let commands = match self.engine {
            Engine::Slurm => format!(
                "job=$(sbatch --parsable {script})\n\
                 job=${{job%%;*}}\n\
                 [ -n \"$job\" ] || {{ echo \"sbatch has named no job\" >&2; exit 1; }}\n\
                 merge=$(sbatch --parsable --job-name={name} --dependency=afterok:\"$job\" --kill-on-invalid-dep=yes \\\n    \
                 --output={log} --wrap {command})\n\
                 merge=${{merge%%;*}}\n\
                 echo \"submitted: array job $job, merge $merge (squeue --me)\"\n",
                script = self.inside("render.slurm"),
                name = quoting::shell(&format!("{}-merge", self.name)),
                log = quoting::shell(&self.log("merge.txt")),
                command = quoting::shell(&format!("sh {merge}")),
            ),
            Engine::Openjd => format!("openjd run {}\n", self.inside("template.yaml")),
            // The lines are commands already, for a second shell, and nothing in them is replaced.
            Engine::Parallel => format!(
                "# JOBS tasks at a time on each machine; with HOSTS, a file with one machine in a line, by ssh.\n\
                 export PARALLEL_SHELL=/bin/sh\n\
                 for task in $(seq {first} {last}); do\n    \
                     printf '%s %s\\0' {command} \"$task\"\n\
                 done | parallel --null --will-cite --jobs \"${{JOBS:-1}}\" ${{HOSTS:+--sshloginfile \"$HOSTS\"}} \\\n    \
                 --joblog {log} --resume-failed\n\
                 sh {merge}\n",
                command = quoting::shell(&format!("sh {task}")),
                log = self.inside("log/tasks.tsv")
            ),
        };
        format!("#!/bin/sh\nset -eu\n{commands}")
    }

    /// A file of Slurm's, whose name may have its `%A`.
    fn log(&self, name: &str) -> String {
        let folder = self.folder.join("log").display().to_string();
        format!("{}/{name}", quoting::slurm_name(&folder))
    }

    fn slurm(&self) -> String {
        let [first, last] = self.span();
        format!(
            "#!/bin/sh\n\
             #SBATCH --job-name={name}\n\
             #SBATCH --array={first}-{last}\n\
             #SBATCH --ntasks=1\n\
             #SBATCH --requeue\n\
             #SBATCH --open-mode=append\n\
             #SBATCH --output={log}\n\
             # Options of sbatch on its command line, such as --cpus-per-task=8 or --time=4:00:00, go before these.\n\
             exec sh {task} \"$SLURM_ARRAY_TASK_ID\"\n",
            name = quoting::sbatch(&self.name),
            log = quoting::sbatch(&self.log("%A_%a.txt")),
            task = self.inside("task.sh")
        )
    }

    /// Names and paths are values of parameters, which are taken as they are: what stands elsewhere in a template is
    /// searched for `{{…}}`.
    fn template(&self) -> String {
        let [first, last] = self.span();
        let text = |text: &str| serde_json::Value::from(text).to_string();
        let path = |script: &str| self.folder.join(script).display().to_string();
        let mut template =
            "specificationVersion: jobtemplate-2023-09\nname: \"{{Param.JobName}}\"\n\
             parameterDefinitions:\n"
                .to_owned();
        for (name, value) in [
            ("JobName", self.name.clone()),
            ("Task", path("task.sh")),
            ("Merge", path("merge.sh")),
        ] {
            let _ = write!(
                template,
                "- name: {name}\n  type: STRING\n  default: {}\n",
                text(&value)
            );
        }
        let step = |name: &str, parameters: &str, arguments: &str| {
            format!(
                "- name: {name}\n{parameters}  script:\n    actions:\n      onRun:\n        command: sh\n        \
                 args: [{arguments}]\n"
            )
        };
        let parameters = format!(
            "  parameterSpace:\n    taskParameterDefinitions:\n    - name: Piece\n      type: INT\n      range: \"{first}-{last}\"\n"
        );
        let arguments = "\"{{Param.Task}}\", \"{{Task.Param.Piece}}\"";
        template += "steps:\n";
        template += &step("Render", &parameters, arguments);
        let waits = "  dependencies:\n  - dependsOn: Render\n";
        template += &step("Merge", waits, "\"{{Param.Merge}}\"");
        template
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn job(engine: Engine, work: Work) -> Job {
        Job {
            engine,
            work,
            name: "box".to_owned(),
            program: "/opt/etalon".into(),
            scene: "/data/my scenes/box.xml".into(),
            folder: "/data/out".into(),
            options: " --spp 64".to_owned(),
        }
    }

    fn file(job: &Job, name: &str) -> String {
        let files = job.files();
        let found = files.iter().find(|file| file.0 == name);
        found.expect("the file").1.clone()
    }

    #[test]
    fn pieces_beyond_the_limit_of_an_array_are_packed() {
        let job = job(
            Engine::Slurm,
            Work::Frames {
                first: 10,
                last: 2509,
            },
        );
        assert!(file(&job, "render.slurm").contains("--array=10-1009\n"));
        let task = file(&job, "task.sh");
        assert!(
            task.contains("-le 2509") && task.contains("piece + 1000"),
            "{task}"
        );
    }

    #[test]
    fn names_with_spaces_reach_the_program_whole() {
        let task = file(&job(Engine::Parallel, Work::Parts(8)), "task.sh");
        assert!(task.contains("render '/data/my scenes/box.xml'"), "{task}");
        assert!(
            task.contains("--part \"$piece\"/8 --resume -q --spp 64\n"),
            "{task}"
        );
    }

    #[test]
    fn every_engine_starts_every_task_and_merges() {
        let task = "sh /data/out/task.sh";
        let of = |engine| job(engine, Work::Parts(8));
        let slurm = of(Engine::Slurm);
        assert!(file(&slurm, "render.slurm").contains(&format!("{task} \"$SLURM_ARRAY_TASK_ID\"")));
        assert!(file(&slurm, "submit.sh").contains("afterok"));
        let parallel = file(&of(Engine::Parallel), "submit.sh");
        assert!(
            parallel.contains("in $(seq 1 8)") && parallel.contains(&format!("'{task}'")),
            "{parallel}"
        );
        let template = file(&of(Engine::Openjd), "template.yaml");
        assert!(template.contains("range: \"1-8\"") && template.contains("dependsOn: Render"));
    }
}
