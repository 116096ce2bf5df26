//! Writing XML.

/// A document being written, indented by nesting.
pub(crate) struct Xml {
    text: String,
    open: Vec<&'static str>,
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;")
}

impl Xml {
    /// A document with a remark at its head.
    pub(crate) fn new(remark: &str) -> Self {
        Self {
            text: format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- {remark} -->\n"),
            open: Vec::new(),
        }
    }

    fn start(&mut self, name: &str, attributes: &[(&str, &str)]) {
        self.text += &"  ".repeat(self.open.len());
        self.text += &format!("<{name}");
        for (name, value) in attributes {
            self.text += &format!(" {name}=\"{}\"", escaped(value));
        }
    }

    /// An element with children.
    pub(crate) fn element(
        &mut self,
        name: &'static str,
        attributes: &[(&str, &str)],
        children: impl FnOnce(&mut Self),
    ) {
        self.start(name, attributes);
        self.text += ">\n";
        self.open.push(name);
        children(self);
        self.open.pop();
        self.text += &"  ".repeat(self.open.len());
        self.text += &format!("</{name}>\n");
    }

    /// An element without any.
    pub(crate) fn leaf(&mut self, name: &str, attributes: &[(&str, &str)]) {
        self.start(name, attributes);
        self.text += "/>\n";
    }

    /// An element that holds a text.
    pub(crate) fn text(&mut self, name: &str, attributes: &[(&str, &str)], text: &str) {
        self.start(name, attributes);
        self.text += &format!(">{}</{name}>\n", escaped(text));
    }

    /// The document.
    pub(crate) fn finish(self) -> String {
        self.text
    }
}
