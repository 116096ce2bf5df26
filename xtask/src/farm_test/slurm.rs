//! A Slurm cluster of two nodes on one machine, for as long as a test lasts.
//!
//! It has its own key, socket, ports and folders, and runs as the current user: nothing of the machine is changed.

use super::find;
use crate::bits::succeed;
use std::fs;
use std::io::Read;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command};
use std::time::{Duration, Instant};

/// Names that no other cluster has, as processes are ended by the name of their node.
const NODES: [&str; 2] = ["etalon-test-1", "etalon-test-2"];

/// The daemons; they end with this.
pub(super) struct Cluster {
    folder: PathBuf,
    /// Those of authentication and control.
    central: Vec<Child>,
    /// Those of the nodes.
    nodes: Vec<Child>,
}

fn failed<'a>(what: &'a Path) -> impl Fn(std::io::Error) -> String + 'a {
    move |error| format!("{}: {error}", what.display())
}

/// What a command says.
fn answer(command: &mut Command) -> Result<String, String> {
    let output = command.output();
    let output = output.map_err(|error| format!("cannot run {command:?}: {error}"))?;
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

impl Cluster {
    /// Starts it, with so many processors in both nodes together.
    pub(super) fn start(folder: &Path, processors: usize) -> Result<Self, String> {
        if folder.exists() {
            fs::remove_dir_all(folder).map_err(failed(folder))?;
        }
        let spools = NODES.map(|node| format!("spool-{node}"));
        for name in ["state", "log"]
            .into_iter()
            .chain(spools.iter().map(String::as_str))
        {
            let made = folder.join(name);
            fs::create_dir_all(&made).map_err(failed(&made))?;
        }
        // `munged` wants the folder of its socket open to all, and writable by its owner alone.
        let open = fs::Permissions::from_mode(0o755);
        fs::set_permissions(folder, open).map_err(failed(folder))?;
        let mut cluster = Self {
            folder: folder.to_owned(),
            central: Vec::new(),
            nodes: Vec::new(),
        };
        cluster.write_key()?;
        cluster.write_configuration(processors)?;
        let munged = cluster.munged()?;
        cluster.central.push(munged);
        let control = cluster.daemon("slurmctld", &["-D"], "slurmctld")?;
        cluster.central.push(control);
        for node in NODES {
            let daemon = cluster.daemon("slurmd", &["-D", "-N", node], node)?;
            cluster.nodes.push(daemon);
        }
        cluster.wait_until(Duration::from_secs(60), "two idle nodes", |cluster| {
            let states = answer(cluster.at_home(Command::new("sinfo").args(["-hN", "-o", "%t"])));
            states.is_ok_and(|states| states.lines().filter(|state| *state == "idle").count() == 2)
        })?;
        Ok(cluster)
    }

    fn inside(&self, name: &str) -> String {
        self.folder.join(name).display().to_string()
    }

    /// A key of its own for who may ask for jobs.
    fn write_key(&self) -> Result<(), String> {
        let mut key = [0; 1024];
        let file = self.folder.join("key");
        let random = fs::File::open("/dev/urandom").and_then(|mut file| file.read_exact(&mut key));
        random
            .and_then(|()| fs::write(&file, key))
            .and_then(|()| fs::set_permissions(&file, fs::Permissions::from_mode(0o600)))
            .map_err(failed(&file))
    }

    fn write_configuration(&self, processors: usize) -> Result<(), String> {
        let host = answer(&mut Command::new("hostname"))?;
        let user = answer(Command::new("id").arg("-un"))?;
        let [socket, state, log, spool] =
            ["socket", "state", "log", "spool-%n"].map(|name| self.inside(name));
        let each = (processors / NODES.len()).max(1);
        let mut text = format!(
            "ClusterName=farm\n\
             SlurmctldHost={host}(127.0.0.1)\n\
             SlurmUser={user}\nSlurmdUser={user}\n\
             AuthType=auth/munge\nCredType=cred/munge\n\
             # What a task is started again after, when its node has failed, is as long as credentials last.\n\
             AuthInfo=socket={socket},cred_expire=20\n\
             SlurmctldPort=16817\n\
             SlurmctldPidFile={state}/slurmctld.pid\nSlurmdPidFile={state}/slurmd-%n.pid\n\
             StateSaveLocation={state}\nSlurmdSpoolDir={spool}\n\
             SlurmctldLogFile={log}/slurmctld.log\nSlurmdLogFile={log}/slurmd-%n.log\n\
             ProctrackType=proctrack/pgid\nTaskPlugin=task/none\nMpiDefault=none\n\
             JobAcctGatherType=jobacct_gather/none\nAccountingStorageType=accounting_storage/none\n\
             SelectType=select/cons_tres\nSelectTypeParameters=CR_Core\nSchedulerType=sched/backfill\n\
             ReturnToService=2\nSlurmdParameters=config_overrides\n\
             SlurmdTimeout=10\nUnkillableStepTimeout=15\nKillWait=5\n"
        );
        for (node, port) in NODES.iter().zip(17001..) {
            text += &format!(
                "NodeName={node} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs={each} State=UNKNOWN\n"
            );
        }
        text += "PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n";
        let file = self.folder.join("slurm.conf");
        fs::write(&file, text).map_err(failed(&file))
    }

    fn munged(&self) -> Result<Child, String> {
        let mut munged = self.command("munged", "munged")?;
        munged.args(["--foreground", "--force"]);
        for name in ["key-file", "socket", "pid-file", "log-file", "seed-file"] {
            let file = match name {
                "key-file" => self.inside("key"),
                "socket" => self.inside("socket"),
                _ => self.inside(&format!("state/munge-{name}")),
            };
            munged.arg(format!("--{name}={file}"));
        }
        let child = munged.spawn();
        let child = child.map_err(|error| format!("cannot run {munged:?}: {error}"))?;
        let socket = self.folder.join("socket");
        self.wait_until(Duration::from_secs(20), "munged", |_| socket.exists())?;
        Ok(child)
    }

    /// A program that knows this cluster, and whose words go to a file of the log.
    fn command(&self, program: &str, log: &str) -> Result<Command, String> {
        let file = self.folder.join("log").join(format!("{log}.txt"));
        let out = fs::File::create(&file).map_err(failed(&file))?;
        let err = out.try_clone().map_err(failed(&file))?;
        let path = find(program).ok_or_else(|| format!("`{program}` is not installed"))?;
        let mut command = Command::new(path);
        self.at_home(&mut command).stdout(out).stderr(err);
        Ok(command)
    }

    fn daemon(&self, program: &str, arguments: &[&str], log: &str) -> Result<Child, String> {
        let mut command = self.command(program, log)?;
        let child = command.args(arguments).spawn();
        child.map_err(|error| format!("cannot run {command:?}: {error}"))
    }

    /// A command that asks this cluster.
    pub(super) fn at_home<'a>(&self, command: &'a mut Command) -> &'a mut Command {
        command.env("SLURM_CONF", self.folder.join("slurm.conf"))
    }

    /// Waits until something holds.
    fn wait_until(
        &self,
        patience: Duration,
        what: &str,
        mut holds: impl FnMut(&Self) -> bool,
    ) -> Result<(), String> {
        let start = Instant::now();
        while !holds(self) {
            if start.elapsed() > patience {
                return Err(format!(
                    "slurm: waited {} s for {what}; see {}",
                    patience.as_secs(),
                    self.inside("log")
                ));
            }
            std::thread::sleep(Duration::from_millis(200));
        }
        Ok(())
    }

    /// Waits until a task of the second node has written a checkpoint; then kills that node's daemon, the task's step and its
    /// render, as a power cut would.
    pub(super) fn kill_a_node_in_a_task(&self, patience: Duration) -> Result<(), String> {
        let node = NODES[1];
        let checkpointed = || {
            processes_of(node).into_iter().any(|pid| {
                let words = words_of(pid, "cmdline");
                let mut images = words.iter().filter(|word| word.ends_with(".exr"));
                images.any(|image| Path::new(&format!("{image}.checkpoint")).exists())
            })
        };
        self.wait_until(patience, "a checkpoint on the second node", |_| {
            checkpointed()
        })?;
        let mut all = vec![self.nodes[1].id()];
        for pid in processes_of(node) {
            all.push(pid);
            all.extend(parent_of(pid).filter(|parent| is_step(*parent)));
        }
        // Some end with others.
        let _ = signal("-KILL", &all);
        println!("slurm: {node} killed in the middle of a task that had written a checkpoint");
        Ok(())
    }

    /// Waits until nothing is left to do.
    pub(super) fn wait_for_queue(&self, patience: Duration) -> Result<(), String> {
        self.wait_until(patience, "the queue to be empty", |cluster| {
            answer(cluster.at_home(Command::new("squeue").arg("-h")))
                .is_ok_and(|queue| queue.is_empty())
        })
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        let user = answer(Command::new("id").arg("-un")).unwrap_or_default();
        let _ = succeed(self.at_home(Command::new("scancel").args(["-u", &user])));
        for node in NODES {
            let _ = signal("-KILL", &processes_of(node));
        }
        for daemon in self.nodes.iter_mut().chain(&mut self.central) {
            let _ = daemon.kill();
            let _ = daemon.wait();
        }
    }
}

fn signal(signal: &str, pids: &[u32]) -> Result<(), String> {
    let mut kill = Command::new("kill");
    kill.arg(signal).args(pids.iter().map(u32::to_string));
    succeed(kill.stderr(std::process::Stdio::null()))
}

/// The words of a file of a process; none of one that is not ours, or has ended.
fn words_of(pid: u32, file: &str) -> Vec<String> {
    let text = fs::read(format!("/proc/{pid}/{file}")).unwrap_or_default();
    let words = text.split(|byte| *byte == 0);
    words
        .map(|word| String::from_utf8_lossy(word).into_owned())
        .collect()
}

/// The processes of tasks on a node.
fn processes_of(node: &str) -> Vec<u32> {
    let mark = format!("SLURMD_NODENAME={node}");
    let entries = fs::read_dir("/proc").into_iter().flatten().flatten();
    entries
        .filter_map(|entry| entry.file_name().to_str()?.parse().ok())
        .filter(|pid| words_of(*pid, "environ").contains(&mark))
        .collect()
}

fn status_of(pid: u32, field: &str) -> Option<String> {
    let text = fs::read_to_string(format!("/proc/{pid}/status")).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(field));
    Some(line?.trim().to_owned())
}

fn parent_of(pid: u32) -> Option<u32> {
    status_of(pid, "PPid:")?.parse().ok()
}

fn is_step(pid: u32) -> bool {
    status_of(pid, "Name:").is_some_and(|name| name == "slurmstepd")
}
