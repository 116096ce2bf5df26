//! Words in the languages of other programs, written so that those read them back as they were: one function for each.

/// A word for a POSIX shell. `shlex` quotes more than a shell asks for; a NUL, which it refuses, no command line held.
pub(crate) fn shell(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,=:+".contains(c);
    match shlex::try_quote(text) {
        Ok(quoted) if !text.chars().all(plain) || text.is_empty() => quoted.into_owned(),
        _ => text.to_owned(),
    }
}

/// A word of an `#SBATCH` line, which is no shell's: a backslash takes the next character as it is, everywhere.
pub(crate) fn sbatch(text: &str) -> String {
    let special = |c: char| c.is_whitespace() || "\\\"'#".contains(c);
    let escaped = text
        .chars()
        .flat_map(|c| special(c).then_some('\\').into_iter().chain([c]));
    escaped.collect()
}

/// Part of a file's name for Slurm, which replaces `%A` and the like in it.
pub(crate) fn slurm_name(text: &str) -> String {
    text.replace('%', "%%")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_for_slurm() {
        assert_eq!(sbatch("/a b/it's#1"), "/a\\ b/it\\'s\\#1");
        assert_eq!(slurm_name("jo b%A"), "jo b%%A");
    }
}
