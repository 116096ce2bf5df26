//! Looking on while a picture renders, and looking at finished ones: what the page is told, who is refused, what `tev` hears.

use crate::workshop::{Ran, Workshop, cornell_box};
use etalon_images::Image;
use std::ffi::OsString;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const PATIENCE: Duration = Duration::from_secs(30);

/// An answer of the page's server.
struct Answer {
    status: u16,
    head: String,
    body: Vec<u8>,
}

/// The address `http://127.0.0.1:PORT/` in what a program says.
fn port_of(lines: impl Read) -> u16 {
    for line in BufReader::new(lines).lines() {
        let line = line.expect("it is text");
        if let Some((_, rest)) = line.split_once("http://127.0.0.1:") {
            return rest.trim_end_matches('/').parse().expect("a port");
        }
    }
    panic!("it names no address");
}

fn ask(port: u16, method: &str, path: &str, host: &str) -> Option<Answer> {
    let mut socket = TcpStream::connect(("127.0.0.1", port)).ok()?;
    socket.set_read_timeout(Some(PATIENCE)).ok()?;
    write!(
        socket,
        "{method} {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"
    )
    .ok()?;
    let mut bytes = Vec::new();
    socket.read_to_end(&mut bytes).ok()?;
    let end = bytes.windows(4).position(|four| four == b"\r\n\r\n")?;
    let head = String::from_utf8_lossy(&bytes[..end]).into_owned();
    let status = head.split(' ').nth(1)?.parse().ok()?;
    let body = bytes[end + 4..].to_vec();
    Some(Answer { status, head, body })
}

fn get(port: u16, path: &str) -> Option<Answer> {
    ask(port, "GET", path, &format!("127.0.0.1:{port}"))
}

fn state(port: u16) -> Option<serde_json::Value> {
    serde_json::from_slice(&get(port, "/state")?.body).ok()
}

fn floats(answer: &Answer) -> Vec<f32> {
    let words = answer.body.chunks_exact(4);
    words
        .map(|word| f32::from_le_bytes([word[0], word[1], word[2], word[3]]))
        .collect()
}

/// The colours of an image, then their standard errors.
fn planes_of(image: &Image) -> Vec<&[f32]> {
    let colours = ["R", "G", "B"];
    let errors = colours.map(|colour| format!("standard_error.{colour}"));
    let names = colours.into_iter().chain(errors.iter().map(String::as_str));
    names
        .map(|name| image.channel(name).expect("it is there"))
        .collect()
}

/// Waits until the state is as wanted.
#[track_caller]
fn until(port: u16, wanted: impl Fn(&serde_json::Value) -> bool) -> serde_json::Value {
    let begin = Instant::now();
    loop {
        let now = state(port).expect("it answers");
        if wanted(&now) {
            return now;
        }
        assert!(begin.elapsed() < PATIENCE, "{now}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// That a refusal says so.
#[track_caller]
fn told(ran: &Ran, words: &str) {
    assert!(ran.stderr.contains(words), "{}", ran.stderr);
}

/// A program that serves a page; ended with the test.
struct Served(Child, u16);

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn preview(workshop: &Workshop, further: &[&str]) -> Served {
    let scene = cornell_box();
    let mut child = (workshop.command())
        .args(["render", &scene, "-o", "a.exr", "--preview"])
        .args(further)
        .stderr(Stdio::piped())
        .spawn()
        .expect("it runs");
    let port = port_of(child.stderr.take().expect("it was asked for"));
    Served(child, port)
}

/// The picture grows while the page looks on; the last one is the file's, and the file has the bits of a render that nobody watches.
#[test]
fn a_page_sees_the_picture_grow() {
    let workshop = Workshop::new();
    let options = ["--size", "96x96", "--spp", "512", "--seed", "4"];
    let mut served = preview(&workshop, &options);
    let port = served.1;
    let early = until(port, |s| s["pictures"][0]["version"].as_u64() >= Some(1));
    let samples = |s: &serde_json::Value| s["pictures"][0]["samples"].as_f64().expect("a number");
    assert!(samples(&early) < 512.0, "{early}");
    assert_eq!(early["progress"]["total"], 96 * 96 * 512);
    assert_eq!(
        [
            &early["pictures"][0]["width"],
            &early["pictures"][0]["height"]
        ],
        [96, 96]
    );
    let later = until(port, |s| samples(s) > samples(&early));
    assert!(later["progress"]["left"].as_f64() > Some(0.0), "{later}");
    // The last picture waits for the page, which goes on asking.
    let last = until(port, |s| s["finished"] == true);
    assert_eq!(samples(&last), 512.0);
    let seen = floats(&get(port, "/picture/0/0").expect("it waits"));
    while state(port).is_some() {
        std::thread::sleep(Duration::from_millis(20));
    }
    assert!(served.0.wait().expect("it ends").success());
    let file = workshop.image("a.exr").image;
    let planes = planes_of(&file);
    assert!(
        seen == planes.concat(),
        "the last picture is not the file's"
    );
    workshop
        .run(
            &[
                &["render", &cornell_box(), "-q", "-o", "b.exr"][..],
                &options,
            ]
            .concat(),
        )
        .fine();
    let unseen = workshop.image("b.exr").image;
    for channel in file.channels() {
        let other = unseen.channel(&channel.name);
        assert!(other == Some(&channel.samples), "{}", channel.name);
    }
}

/// Only pages of this machine may ask, and only to read; the page brings all that it needs.
#[test]
fn strangers_are_refused() {
    let workshop = Workshop::new();
    let served = preview(
        &workshop,
        &["--size", "32x32", "--spp", "16777216", "--replicates", "1"],
    );
    let port = served.1;
    for (host, status) in [
        (format!("127.0.0.1:{port}"), 200),
        (format!("localhost:{port}"), 200),
        (format!("evil.example:{port}"), 403),
        ("127.0.0.1".to_owned(), 403),
        (String::new(), 403),
    ] {
        let answer = ask(port, "GET", "/state", &host).expect("it answers");
        assert_eq!(answer.status, status, "{host}");
    }
    let own = format!("127.0.0.1:{port}");
    assert_eq!(
        ask(port, "POST", "/state", &own)
            .expect("it answers")
            .status,
        405
    );
    for path in [
        "/nothing",
        "/picture/7/0",
        "/picture/0/99",
        "/picture/x/y",
        "/../etc/passwd",
    ] {
        assert_eq!(get(port, path).expect("it answers").status, 404, "{path}");
    }
    let page = get(port, "/").expect("it answers");
    let text = String::from_utf8(page.body).expect("it is text");
    assert!(page.head.contains("default-src 'none'"), "{}", page.head);
    assert!(
        !text.contains("http:") && !text.contains("https:"),
        "{text}"
    );
    for part in ["page.css", "page.js"] {
        assert!(text.contains(part));
        assert_eq!(
            get(port, &format!("/{part}")).expect("it answers").status,
            200
        );
    }
}

/// What cannot be had is told before anything is rendered.
#[test]
fn a_port_that_is_taken_is_told() {
    let workshop = Workshop::new();
    let taken = TcpListener::bind("127.0.0.1:0").expect("a port is free");
    let port = taken.local_addr().expect("it has one").port().to_string();
    let scene = cornell_box();
    let refused = workshop.run(&["render", &scene, "-o", "a.exr", "--preview", &port]);
    told(
        &refused.refused(),
        &format!("nothing can be shown on port {port}"),
    );
    drop(taken);
    let nobody = format!("127.0.0.1:{port}");
    let refused = workshop.run(&["render", &scene, "-o", "a.exr", "--tev", &nobody]);
    told(&refused.refused(), &format!("no `tev` listens at {nobody}"));
    for wrong in [
        ["--preview", "0"],
        ["--preview", "scene.xml"],
        ["--tev", "here"],
    ] {
        let refused = workshop.run(&[&["render", &scene, "-o", "a.exr"][..], &wrong].concat());
        told(&refused.refused(), "expected");
    }
    assert!(!workshop.path("a.exr").exists());
}

/// Two files, each with its layers; one that changes is read again.
#[test]
fn finished_pictures_are_shown() {
    let workshop = Workshop::new();
    let render = |output: &str, spp: &str| {
        let scene = cornell_box();
        let words = [
            "render", &scene, "-q", "-o", output, "--size", "16x12", "--spp", spp,
        ];
        workshop.run(&words).fine();
    };
    render("a.exr", "16");
    render("b.exr", "32");
    let mut child = (workshop.command())
        .args([
            "view",
            "a.exr",
            "b.exr",
            "--exposure",
            "1.5",
            "--view",
            "filmic",
        ])
        .stdout(Stdio::piped())
        .spawn()
        .expect("it runs");
    let port = port_of(child.stdout.take().expect("it was asked for"));
    let served = Served(child, port);
    let now = state(port).expect("it answers");
    assert_eq!(now["exposure"], 1.5);
    assert_eq!(now["view"], "filmic");
    let names: Vec<_> = [0, 1].map(|k| now["pictures"][k]["name"].clone()).into();
    assert_eq!(names, ["a.exr", "b.exr"]);
    assert_eq!(now["pictures"][1]["samples"], 32.0);
    assert_eq!(
        floats(&get(port, "/picture/1/0").expect("it answers")).len(),
        6 * 16 * 12
    );
    std::thread::sleep(Duration::from_millis(20));
    render("a.exr", "64");
    let changed = until(port, |s| s["pictures"][0]["version"] == 2);
    assert_eq!(changed["pictures"][0]["samples"], 64.0);
    drop(served);
    workshop.write("empty.txt", "nothing");
    told(&workshop.run(&["view", "empty.txt"]).refused(), "empty.txt");
    told(&workshop.run(&["view", "none.exr"]).refused(), "none.exr");
}

/// Kinds of messages to `tev`.
const CREATE: u8 = 4;
const UPDATE: u8 = 6;

/// Reads what a client of `tev` sends: messages that begin with their length.
fn heard(socket: &mut TcpStream) -> Vec<Vec<u8>> {
    let mut bytes = Vec::new();
    socket.read_to_end(&mut bytes).expect("it ends");
    let mut rest = bytes.as_slice();
    let mut messages = Vec::new();
    while rest.len() >= 4 {
        let length = u32::from_le_bytes([rest[0], rest[1], rest[2], rest[3]]) as usize;
        messages.push(rest[4..length].to_vec());
        rest = &rest[length..];
    }
    assert!(rest.is_empty());
    messages
}

/// The image is made once and then filled, band by band; what was sent last is the file's.
#[test]
fn tev_hears_the_picture() {
    let workshop = Workshop::new();
    let viewer = TcpListener::bind("127.0.0.1:0").expect("a port is free");
    let address = viewer.local_addr().expect("it has one").to_string();
    let scene = cornell_box();
    let child = (workshop.command())
        .args([
            "render", &scene, "-q", "-o", "a.exr", "--size", "8x100", "--spp", "16",
        ])
        .args(["--tev", &address])
        .spawn()
        .expect("it runs");
    let (mut socket, _) = viewer.accept().expect("it calls");
    let messages = heard(&mut socket);
    let output = child.wait_with_output().expect("it ends");
    assert!(output.status.success());
    assert_eq!(messages[0][0], CREATE);
    assert!(
        messages
            .iter()
            .filter(|message| message[0] == UPDATE)
            .count()
            >= 2
    );
    // The last two messages are the last picture: rows 0 to 63 and 64 to 99, plane by plane.
    let file = workshop.image("a.exr").image;
    let planes = planes_of(&file);
    let last = &messages[messages.len() - 2..];
    for (band, first, rows) in [(&last[0], 0, 64), (&last[1], 64, 36)] {
        assert_eq!(band[0], UPDATE);
        let count = 8 * rows * planes.len();
        let data = &band[band.len() - 4 * count..];
        let sent: Vec<f32> = (data.chunks_exact(4))
            .map(|word| f32::from_le_bytes([word[0], word[1], word[2], word[3]]))
            .collect();
        let expected = planes
            .iter()
            .flat_map(|plane| &plane[8 * first..8 * (first + rows)]);
        assert!(sent.iter().eq(expected), "{first}");
    }
}

/// The page draws the pictures in a real browser, if there is one: its script has read the state and the numbers, and offers the maps that
/// they allow. Mutants rejected: a script with an error, a policy that blocks it, a picture that is not fetched.
#[test]
fn a_browser_shows_the_page() {
    let names = ["chromium", "chromium-browser", "google-chrome", "chrome"].map(Into::into);
    let named = std::env::var_os("ETALON_CHROMIUM").into_iter();
    let runs = |name: &OsString| Command::new(name).arg("--version").output().is_ok();
    let Some(browser) = named.chain(names).find(runs) else {
        let told =
            "SKIPPED: the preview's page was not tried in a browser, as there is no Chromium.\n";
        let _ = std::io::stderr().write_all(told.as_bytes());
        return;
    };
    let workshop = Workshop::new();
    let scene = cornell_box();
    for (output, seed) in [("a.exr", "1"), ("b.exr", "2")] {
        let words = [
            "render", &scene, "-q", "-o", output, "--size", "16x12", "--spp", "16",
        ];
        workshop
            .run(&[&words[..], &["--seed", seed]].concat())
            .fine();
    }
    let mut child = (workshop.command())
        .args(["view", "a.exr", "b.exr", "--exposure", "2"])
        .stdout(Stdio::piped())
        .spawn()
        .expect("it runs");
    let port = port_of(child.stdout.take().expect("it was asked for"));
    let _served = Served(child, port);
    let shown = Command::new(browser)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--no-first-run",
        ])
        .args([
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
        ])
        .arg(format!(
            "--user-data-dir={}",
            workshop.path("profile").display()
        ))
        .args(["--virtual-time-budget=5000", "--dump-dom"])
        .arg(format!("http://127.0.0.1:{port}/"))
        .output()
        .expect("it runs");
    let page = String::from_utf8_lossy(&shown.stdout);
    for words in [
        ">a.exr and b.exr</span>",
        ">16 samples per pixel<",
        ">+2 EV<",
        ">standard error</option>",
        ">difference in standard errors</option>",
        "id=\"empty\" hidden",
    ] {
        assert!(page.contains(words), "{words}: {page}");
    }
}
