//! A page in a real browser, without a driver: a script that is put into the page exercises it and
//! tells what it found to a frame around it, which writes it to the console, that is to standard
//! error, and closes the window. The frame has the size that is asked for; a window is never as
//! narrow as a phone.

use serde::Deserialize;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// What a script found.
#[derive(Debug, Deserialize)]
pub(crate) struct LightSearch {
    pub(crate) name: String,
    pub(crate) fine: bool,
    pub(crate) detail: String,
}

/// How long a browser may take; it takes seconds.
const LIMIT: Duration = Duration::from_secs(60);

/// Keeps errors from the very beginning of a page.
const ERRORS: &str = "<script>window.failures=[];\
addEventListener('error',e=>failures.push(e.message));\
addEventListener('unhandledrejection',e=>failures.push(String(e.reason)));\
addEventListener('securitypolicyviolation',e=>failures.push('blocked '+e.blockedURI));</script>";

/// The browser: `ETALON_CHROMIUM`, or Chromium or Chrome on the search path. Without one it says so,
/// on standard error, past the test harness, which would swallow it.
pub(crate) fn found() -> Option<PathBuf> {
    if let Some(path) = std::env::var_os("ETALON_CHROMIUM") {
        return Some(path.into());
    }
    let names = ["chromium", "chromium-browser", "google-chrome", "chrome"];
    let folders: Vec<PathBuf> = std::env::var_os("PATH")
        .map(|path| std::env::split_paths(&path).collect())
        .unwrap_or_default();
    let candidates = names
        .iter()
        .flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
    let browser = candidates.into_iter().find(|path| path.is_file());
    if browser.is_none() {
        let message = "SKIPPED: the report was not tried in a browser, as there is no Chromium. \
             Install it (`apt-get install chromium`) or name one in ETALON_CHROMIUM.\n";
        let _ = std::io::Write::write_all(&mut std::io::stderr(), message.as_bytes());
    }
    browser
}

/// A folder of one test's own, removed at its end.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("etalon-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).expect("a temporary folder");
        Self(path)
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // What a dying browser still writes may be in the way; the system clears it up.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Opens the page at this size, runs the script in it, and says what it found, the page's own
/// errors among it.
pub(crate) fn exercise(
    browser: &Path,
    folder: &Path,
    html: &str,
    script: &str,
    [width, height]: [u32; 2],
) -> Vec<LightSearch> {
    let page = folder.join("page.html");
    let html = html
        .replacen("<head>", &format!("<head>{ERRORS}"), 1)
        .replacen("</body>", &format!("<script>{script}</script></body>"), 1);
    fs::write(&page, html).expect("written");
    let around = folder.join("around.html");
    let frame = format!(
        "<!DOCTYPE html><script>addEventListener('message',e=>{{\
         for(const f of e.data)console.log('FINDING '+JSON.stringify(f));\
         console.log('FINDINGS '+e.data.length);setTimeout(()=>window.close(),100)}})</script>\
         <iframe src=\"page.html\" width=\"{width}\" height=\"{height}\" style=\"border:0\"></iframe>"
    );
    fs::write(&around, frame).expect("written");
    let log = folder.join("log.txt");
    let profile = folder.join("profile");
    let mut process = Command::new(browser)
        .args(["--headless=new", "--disable-gpu", "--no-first-run"])
        // Root has no sandbox, as in containers. The page is ours.
        .args(["--no-sandbox", "--disable-dev-shm-usage"])
        .args(["--enable-logging=stderr", "--v=0"])
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("--window-size={},{}", width + 50, height + 100))
        .arg(format!("file://{}", around.display()))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(File::create(&log).expect("a file"))
        .spawn()
        .expect("the browser starts");
    let start = Instant::now();
    while process.try_wait().expect("a process").is_none() {
        if start.elapsed() > LIMIT {
            let _ = process.kill();
            let _ = process.wait();
            let log = fs::read_to_string(&log).unwrap_or_default();
            panic!("the browser did not end within {LIMIT:?}: {log}");
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    let log = fs::read(&log).expect("readable");
    understood(&String::from_utf8_lossy(&log))
}

/// What the console was told.
fn understood(log: &str) -> Vec<LightSearch> {
    let (mut findings, mut announced, mut said) = (Vec::new(), None, Vec::new());
    for line in log.lines().filter(|line| line.contains(":CONSOLE:")) {
        let told = |what: &str| {
            let (_, rest) = line.split_once(&format!("\"{what} "))?;
            Some(rest.rsplit_once("\", source:")?.0)
        };
        if let Some(text) = told("FINDING") {
            findings.push(serde_json::from_str(text).expect("a finding"));
        } else if let Some(text) = told("FINDINGS") {
            announced = text.parse().ok();
        } else {
            said.push(line);
        }
    }
    let complete = announced == Some(findings.len());
    assert!(complete, "the script did not end: {log}");
    findings.push(LightSearch {
        name: "the console is silent".to_owned(),
        fine: said.is_empty(),
        detail: said.join("; "),
    });
    findings
}

/// The names of what was not fine, with what was found instead.
pub(crate) fn failures(findings: &[LightSearch]) -> Vec<String> {
    let bad = findings.iter().filter(|finding| !finding.fine);
    bad.map(|finding| format!("{}: {}", finding.name, finding.detail))
        .collect()
}
