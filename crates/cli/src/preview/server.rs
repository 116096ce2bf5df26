//! The server: loopback only, for pages that this program made.
//!
//! A page of another site in the same browser can ask a server on 127.0.0.1, and by a name of its own that suddenly means 127.0.0.1 even
//! read the answers. So a request must name this host and port, and nothing but reading is possible.

use super::feed::Feed;
use etalon_render::report::COLOURS;
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use tiny_http::{Header, Method, Request, Response, Server};

const PAGE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// What the page may load: what this server gives.
const POLICY: &str = "default-src 'none'; connect-src 'self'; style-src 'self'; script-src 'self'; img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// Requests are answered by so many threads, so that a large picture holds up no state.
const THREADS: usize = 3;

/// Listens on a port of 127.0.0.1, on any that is free if it is 0; gives the port.
pub(super) fn listen(port: u16) -> Result<(Server, u16), String> {
    let address = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
    let server = Server::http(address).map_err(|error| error.to_string())?;
    let port = server
        .server_addr()
        .to_ip()
        .map_or(port, |address| address.port());
    Ok((server, port))
}

/// Answers requests from now on.
pub(super) fn serve(server: Server, port: u16, feed: &Arc<Feed>) {
    let server = Arc::new(server);
    for _ in 0..THREADS {
        let (server, feed) = (Arc::clone(&server), Arc::clone(feed));
        std::thread::spawn(move || {
            for request in server.incoming_requests() {
                let answer = answer(&request, port, &feed);
                // Whoever asked may be gone.
                let _ = request.respond(answer);
            }
        });
    }
}

type Answer = Response<std::io::Cursor<Vec<u8>>>;

fn answer(request: &Request, port: u16, feed: &Feed) -> Answer {
    let host = request
        .headers()
        .iter()
        .find(|header| header.field.equiv("Host"));
    let host = host.map_or("", |header| header.value.as_str());
    let is_ours = ["127.0.0.1", "localhost"]
        .iter()
        .any(|name| host == format!("{name}:{port}"));
    if !is_ours {
        return text("this server answers on 127.0.0.1 only").with_status_code(403);
    }
    if *request.method() != Method::Get {
        return text("only GET is possible").with_status_code(405);
    }
    let path = request.url().split('?').next().unwrap_or_default();
    match path {
        "/" => with_type(PAGE, "text/html; charset=utf-8"),
        "/page.css" => with_type(STYLE, "text/css; charset=utf-8"),
        "/page.js" => with_type(
            &[COLOURS, SCRIPT].concat(),
            "text/javascript; charset=utf-8",
        ),
        "/state" => with_type(&feed.state().to_string(), "application/json"),
        _ => picture(path, feed)
            .unwrap_or_else(|| text("there is nothing here").with_status_code(404)),
    }
}

/// `/picture/0/1`: the numbers of layer 1 of picture 0, as little-endian 32-bit floats.
fn picture(path: &str, feed: &Feed) -> Option<Answer> {
    let (picture, layer) = path.strip_prefix("/picture/")?.split_once('/')?;
    let (planes, version) = feed.planes(picture.parse().ok()?, layer.parse().ok()?)?;
    let bytes: Vec<u8> = planes
        .values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    let [width, height] = planes.size;
    // In one piece, with its length.
    let mut answer = Response::from_data(bytes).with_chunked_threshold(usize::MAX);
    let facts = [
        ("Content-Type", "application/octet-stream".to_owned()),
        ("X-Size", format!("{width}x{height}")),
        ("X-Version", version.to_string()),
    ];
    for (name, value) in facts {
        answer.add_header(header(name, &value));
    }
    Some(guarded(answer))
}

fn text(message: &str) -> Answer {
    with_type(message, "text/plain; charset=utf-8")
}

fn with_type(body: &str, kind: &str) -> Answer {
    guarded(Response::from_data(body.as_bytes()).with_header(header("Content-Type", kind)))
}

fn guarded(answer: Answer) -> Answer {
    let headers = [
        ("Cache-Control", "no-store"),
        ("Content-Security-Policy", POLICY),
        ("X-Content-Type-Options", "nosniff"),
        ("Referrer-Policy", "no-referrer"),
        ("Cross-Origin-Resource-Policy", "same-origin"),
    ];
    headers.into_iter().fold(answer, |answer, (name, value)| {
        answer.with_header(header(name, value))
    })
}

fn header(name: &str, value: &str) -> Header {
    Header::from_bytes(name, value).expect("names and values of headers are ASCII")
}
