//! `cargo xtask farm-test`: the job files of `etalon farm`, run by the engines that they are for.
//!
//! A picture is rendered at once, and again as tasks by GNU parallel, Open Job Description, and Slurm with two nodes on this
//! machine, one of which is killed in the middle of a task. All pictures must have the same bits (`SOURCE_DATE_EPOCH` leaves
//! render times out of them). An engine that is not installed is skipped with a word.

mod slurm;

use crate::bits::succeed;
use clap::ValueEnum;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

/// The job files of `etalon farm`, run by the engines that they are for
#[derive(clap::Args)]
#[command(
    after_help = "An engine that is not installed is skipped. Debian's packages: parallel; slurmctld slurmd slurm-client munge. \
                  OpenJD: pip install openjd-cli.\n\nExamples:\n  cargo xtask farm-test\n  cargo xtask farm-test --only slurm"
)]
pub(crate) struct Arguments {
    /// Only this engine
    #[arg(long, value_enum)]
    only: Option<Engine>,
    /// Samples per pixel of the picture: enough that a task lasts longer than it takes to write a checkpoint
    #[arg(long, default_value_t = 4096)]
    spp: u32,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Engine {
    Parallel,
    Openjd,
    Slurm,
}

impl Engine {
    /// Its name, as `etalon farm` knows it.
    fn name(self) -> &'static str {
        match self {
            Self::Parallel => "parallel",
            Self::Openjd => "openjd",
            Self::Slurm => "slurm",
        }
    }

    /// The programs that it needs.
    fn programs(self) -> &'static [&'static str] {
        match self {
            Self::Parallel => &["parallel"],
            Self::Openjd => &["openjd"],
            Self::Slurm => &["slurmctld", "slurmd", "sbatch", "scancel", "munged"],
        }
    }
}

/// Parts of the picture, and replicates to deal to them.
const PARTS: &str = "8";
const REPLICATES: &str = "32";

/// No engine may take longer.
const PATIENCE: Duration = Duration::from_secs(900);

/// The scene to render, and the program.
struct Workshop {
    program: PathBuf,
    scene: PathBuf,
    folder: PathBuf,
    spp: String,
    /// Tasks at a time, each with one thread.
    threads: usize,
}

impl Workshop {
    /// `etalon`, told to do the same thing for every engine.
    fn etalon(&self, command: &str, threads: &str) -> Command {
        let mut etalon = Command::new(&self.program);
        etalon
            .args([command, "-q", "--replicates", REPLICATES])
            .args(["--spp", &self.spp, "--threads", threads])
            .args(["-D", "resx=96", "-D", "resy=96"])
            .arg(&self.scene)
            .env("SOURCE_DATE_EPOCH", "0");
        etalon
    }

    /// The same picture, rendered at once: its bytes, and how long it took.
    fn whole(&self) -> Result<(Vec<u8>, Duration), String> {
        let file = self.folder.join("whole.exr");
        let start = Instant::now();
        let threads = self.threads.to_string();
        succeed(self.etalon("render", &threads).arg("-o").arg(&file))?;
        Ok((read(&file)?, start.elapsed()))
    }

    /// The job files for an engine: where they are.
    fn job(&self, engine: Engine) -> Result<PathBuf, String> {
        let job = self.folder.join(engine.name());
        if job.exists() {
            fs::remove_dir_all(&job).map_err(|error| format!("{}: {error}", job.display()))?;
        }
        let mut farm = self.etalon("farm", "1");
        farm.args(["--engine", engine.name(), "--parts", PARTS, "-o"]);
        succeed(farm.arg(&job).stdout(std::process::Stdio::null()))?;
        Ok(job)
    }

    /// Has the job done by its engine.
    fn run(&self, engine: Engine, job: &Path) -> Result<(), String> {
        let mut submit = Command::new("sh");
        submit
            .arg(job.join("submit.sh"))
            .env("SOURCE_DATE_EPOCH", "0");
        match engine {
            Engine::Parallel => succeed(submit.env("JOBS", self.threads.to_string())),
            Engine::Openjd => {
                let mut check = Command::new("openjd");
                succeed(check.arg("check").arg(job.join("template.yaml")))?;
                let log = fs::File::create(job.join("log/openjd.txt"));
                let log = log.map_err(|error| format!("{}: {error}", job.display()))?;
                succeed(submit.stdout(log))
            }
            Engine::Slurm => {
                let cluster = slurm::Cluster::start(&self.folder.join("cluster"), self.threads)?;
                succeed(cluster.at_home(&mut submit))?;
                cluster.kill_a_node_in_a_task(PATIENCE)?;
                cluster.wait_for_queue(PATIENCE)
            }
        }
    }
}

fn read(file: &Path) -> Result<Vec<u8>, String> {
    fs::read(file).map_err(|error| format!("{}: {error}", file.display()))
}

/// Where a program is. Daemons are not always on the search path of those who are not root.
fn find(program: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::env::split_paths(&path).chain(["/usr/sbin".into(), "/sbin".into()]);
    let mut files = folders.map(|folder| folder.join(program));
    files.find(|file| file.is_file())
}

/// Runs all engines that there are.
pub(crate) fn run(arguments: &Arguments) -> Result<(), String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let root = root.parent().ok_or("xtask lies in no workspace")?;
    let mut build = Command::new("cargo");
    build.args(["build", "--quiet", "--package", "etalon", "--profile"]);
    succeed(build.arg("proof").current_dir(root))?;
    let workshop = Workshop {
        program: root.join("target/proof/etalon"),
        scene: root.join("scenes/cornell-box/scene.xml"),
        folder: root.join("target/farm-test"),
        spp: arguments.spp.to_string(),
        threads: std::thread::available_parallelism().map_or(2, usize::from),
    };
    let folder = &workshop.folder;
    fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let (whole, alone) = workshop.whole()?;
    let alone = alone.as_secs_f64();
    println!("one render: {alone:.1} s with {} threads", workshop.threads);
    let wanted = |engine: &&Engine| arguments.only.is_none_or(|only| only == **engine);
    for &engine in Engine::value_variants().iter().filter(wanted) {
        let name = engine.name();
        let missing = engine
            .programs()
            .iter()
            .find(|program| find(program).is_none());
        if let Some(program) = missing {
            println!("{name}: skipped, as `{program}` is not installed");
            continue;
        }
        let job = workshop.job(engine)?;
        let start = Instant::now();
        workshop.run(engine, &job)?;
        let took = start.elapsed().as_secs_f64();
        if read(&job.join("cornell-box.exr"))? != whole {
            return Err(format!(
                "{name}: the picture in {} differs from that of one render",
                job.display()
            ));
        }
        let with = match engine {
            Engine::Openjd => ", one at a time",
            Engine::Slurm => ", a node killed on the way",
            Engine::Parallel => "",
        };
        println!(
            "{name}: the bits of one render; {PARTS} tasks of one thread{with} and the merge took {took:.1} s, {:.2} times as long",
            took / alone
        );
    }
    Ok(())
}
