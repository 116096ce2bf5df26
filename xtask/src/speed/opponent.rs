//! Mitsuba 3 in a process of its own, which renders a picture whenever it is told to.

use super::Arguments;
use crate::references::mitsuba;
use etalon_validation::folders;
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// The process, with a scene loaded.
pub(super) struct Opponent {
    process: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    size: [usize; 2],
    /// Where it puts its pictures.
    file: PathBuf,
}

impl Opponent {
    /// Starts it, and waits until all is compiled.
    pub(super) fn start(
        python: &Path,
        arguments: &Arguments,
        scene: &Path,
        defines: &[(String, String)],
    ) -> Result<Self, String> {
        let folder = folders::root().join("target/speed");
        fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        let mut command = Command::new(python);
        command
            .arg(folders::root().join("benches/mitsuba_speed.py"))
            .arg(scene)
            .args(["--spp", &arguments.spp.to_string()])
            .args(["--threads", &arguments.threads.to_string()])
            .args(["--variant", &arguments.variant])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped());
        if let Some(filter) = arguments.filter.name() {
            command.args(["--filter", filter]);
        }
        for (key, value) in defines {
            command.arg("-D").arg(format!("{key}={value}"));
        }
        mitsuba::find_llvm(&mut command);
        let mut process = command
            .spawn()
            .map_err(|e| format!("{}: {e}", python.display()))?;
        let pipes = process.stdin.take().zip(process.stdout.take());
        let (input, output) = pipes.ok_or("Mitsuba has no pipes")?;
        let mut opponent = Self {
            process,
            input,
            output: BufReader::new(output),
            size: [0; 2],
            file: folder.join(format!("{}.raw", std::process::id())),
        };
        let said = opponent.answer()?;
        let mut words = said.split_whitespace().skip(1).map(str::parse);
        opponent.size = match [words.next(), words.next()] {
            [Some(Ok(width)), Some(Ok(height))] => [width, height],
            _ => return Err(format!("Mitsuba said `{said}`")),
        };
        Ok(opponent)
    }

    /// The number of its pixels.
    pub(super) fn pixels(&self) -> u64 {
        self.size.iter().map(|n| *n as u64).product()
    }

    /// Has it render a picture: its pixels, and how long it took (s).
    pub(super) fn picture(
        &mut self,
        arguments: &Arguments,
        seed: u32,
    ) -> Result<(impl Iterator<Item = [f32; 3]> + use<>, f64), String> {
        let before = arguments.cpu_seconds(self.process.id())?;
        let order = writeln!(self.input, "{seed} {}", self.file.display());
        order.map_err(|e| format!("Mitsuba: {e}"))?;
        let said = self.answer()?;
        let wall: f64 = said
            .parse()
            .map_err(|_| format!("Mitsuba said `{said}` in place of its time"))?;
        let after = arguments.cpu_seconds(self.process.id())?;
        let seconds = (before.zip(after)).map_or(wall, |(before, after)| after - before);
        let bytes = fs::read(&self.file).map_err(|e| format!("{}: {e}", self.file.display()))?;
        let numbers: Vec<f32> = bytes
            .as_chunks()
            .0
            .iter()
            .map(|bytes| f32::from_le_bytes(*bytes))
            .collect();
        let pixels =
            (0..numbers.len() / 3).map(move |i| std::array::from_fn(|c| numbers[3 * i + c]));
        Ok((pixels, seconds))
    }

    /// A line of its output, without those of its libraries.
    fn answer(&mut self) -> Result<String, String> {
        loop {
            let mut line = String::new();
            match self.output.read_line(&mut line) {
                Ok(0) => return Err("Mitsuba ended without an answer".to_owned()),
                Ok(_) => {}
                Err(e) => return Err(format!("Mitsuba: {e}")),
            }
            let line = line.trim();
            if line.starts_with("ready ") || line.parse::<f64>().is_ok() {
                return Ok(line.to_owned());
            }
        }
    }
}

impl Drop for Opponent {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.process.kill();
        let _ = self.process.wait();
        let _ = fs::remove_file(&self.file);
    }
}
