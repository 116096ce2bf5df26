//! A port, as the command line names it.

/// A port of this machine, or any that is free.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Port(pub Option<u16>);

/// A port, or `any`.
pub(crate) fn parse_port(text: &str) -> Result<Port, String> {
    match text.parse() {
        _ if text == "any" => Ok(Port(None)),
        Ok(port) if port > 0 => Ok(Port(Some(port))),
        _ => Err("expected the number of a port from 1 to 65535, such as 8750; other words go before the option".to_owned()),
    }
}
