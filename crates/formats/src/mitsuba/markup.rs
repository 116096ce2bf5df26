//! What scene files contain that the XML standard forbids or that scenes have no use for, made
//! harmless before the parser sees it.
//!
//! - `--` inside of a comment: other readers of scenes look for `-->` only.
//! - `<!DOCTYPE scene>`: says nothing about a scene. Declarations of entities are refused, since
//!   a few of them can stand for gigabytes of text; all other declarations are skipped.
//! - white space or comments before `<?xml …?>`, which then says nothing new.
//!
//! What is taken out is replaced by as many blanks, so that every position stays what it is.

use etalon_params::{Diagnostic, FileId, Span};
use std::borrow::Cow;
use std::ops::Range;

/// The text for the parser, or what is refused in it.
pub(crate) fn tolerated(text: &str, file: FileId) -> Result<Cow<'_, str>, Diagnostic> {
    let mut blank = Vec::new();
    let mut before_root = true;
    let mut at = 0;
    while let Some(found) = text[at..].find('<') {
        let start = at + found;
        let rest = &text[start..];
        let length = if let Some(inside) = rest.strip_prefix("<!--") {
            let Some(length) = inside.find("-->") else {
                break;
            };
            let hyphens = inside[..length].match_indices('-');
            let spaced = hyphens.map(|(i, _)| start + 4 + i).map(|i| i..i + 1);
            blank.extend(spaced);
            4 + length + 3
        } else if rest.starts_with("<![CDATA[") {
            rest.find("]]>").map_or(rest.len(), |end| end + 3)
        } else if let Some(inside) = rest.strip_prefix("<?") {
            let length = rest.find("?>").map_or(rest.len(), |end| end + 2);
            if before_root && start > 0 && inside.starts_with("xml") {
                blank.push(start..start + length);
            }
            length
        } else if before_root && is_document_type(rest) {
            // One that does not end is the parser's to complain about.
            let Some(length) = document_type(rest) else {
                break;
            };
            if let Some(entity) = rest[..length].find("<!ENTITY") {
                let place = start + entity;
                return Err(entities(file, place));
            }
            blank.push(start..start + length);
            length
        } else {
            before_root = false;
            1
        };
        at = start + length;
    }
    Ok(blanked(text, &blank))
}

fn entities(file: FileId, place: usize) -> Diagnostic {
    let span = Span {
        file,
        start: place as u32,
        end: (place + "<!ENTITY".len()) as u32,
    };
    Diagnostic::error(span, "a scene cannot declare entities")
        .help("use `<default>` and `$name`, or `<include>`, instead")
}

fn is_document_type(text: &str) -> bool {
    text.get(..9)
        .is_some_and(|head| head.eq_ignore_ascii_case("<!DOCTYPE"))
}

/// How long the document type declaration at the start of `text` is; `None` if it does not end.
fn document_type(text: &str) -> Option<usize> {
    let mut in_subset = false;
    let mut at = 0;
    loop {
        let rest = &text[at..];
        if let Some(inside) = rest.strip_prefix("<!--") {
            at += 4 + inside.find("-->")? + 3;
            continue;
        }
        let c = rest.chars().next()?;
        match c {
            '"' | '\'' => at += 1 + rest[1..].find(c)?,
            '[' => in_subset = true,
            ']' => in_subset = false,
            '>' if !in_subset => return Some(at + 1),
            _ => {}
        }
        at += text[at..].chars().next()?.len_utf8();
    }
}

/// The text with blanks in some places.
fn blanked<'a>(text: &'a str, places: &[Range<usize>]) -> Cow<'a, str> {
    if places.is_empty() {
        return Cow::Borrowed(text);
    }
    let mut result = String::with_capacity(text.len());
    let mut done = 0;
    for place in places {
        result.push_str(&text[done..place.start]);
        let blank = |byte: u8| if byte == b'\n' { '\n' } else { ' ' };
        result.extend(text[place.clone()].bytes().map(blank));
        done = place.end;
    }
    result.push_str(&text[done..]);
    Cow::Owned(result)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> String {
        match tolerated(text, FileId(0)) {
            Ok(read) => {
                assert_eq!(read.len(), text.len(), "positions stay");
                read.into_owned()
            }
            Err(diagnostic) => format!("{} at {:?}", diagnostic.message, diagnostic.span),
        }
    }

    #[test]
    fn comments_may_contain_hyphens() {
        assert_eq!(read("<!-- a -- b --><a/>"), "<!-- a    b --><a/>");
        assert_eq!(read("<a><!----- é --->-</a>"), "<a><!--    é  -->-</a>");
        // Neither in text, in attributes nor in what is no comment.
        let whole = "<a b='--'>--<![CDATA[<!-- -- -->]]></a>";
        assert_eq!(read(whole), whole);
        assert_eq!(read("<a><!-- -- "), "<a><!-- -- ");
    }

    #[test]
    fn document_types_are_skipped_and_entities_refused() {
        assert_eq!(read("<!DOCTYPE s>\n<s/>"), "            \n<s/>");
        let subset = "<!DOCTYPE s SYSTEM 'a>' [\n<!-- ] --><!ELEMENT s ANY>\n]>";
        let skipped = read(&format!("<?xml?>{subset}<s/>"));
        assert_eq!(skipped.trim_start_matches("<?xml?>").trim(), "<s/>");
        assert_eq!(skipped.matches('\n').count(), 2);
        let refused = read("<!DOCTYPE s [ <!ENTITY a 'b'> ]><s/>");
        assert!(refused.starts_with("a scene cannot declare entities"));
        // Only before the root, where it is one.
        assert_eq!(read("<s><!DOCTYPE s></s>"), "<s><!DOCTYPE s></s>");
        assert_eq!(read("<!DOCTYPE s [ <s/>"), "<!DOCTYPE s [ <s/>");
    }

    #[test]
    fn a_declaration_may_follow_blanks() {
        assert_eq!(read("<?xml a?><s/>"), "<?xml a?><s/>");
        assert_eq!(read("\n<?xml a?><s/>"), "\n         <s/>");
    }
}
