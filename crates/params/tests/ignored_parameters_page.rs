//! `docs/ignored-parameters.md` says what `ignored.rs` says.

#[test]
fn the_page_is_up_to_date() {
    let page =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/ignored-parameters.md");
    let expected = etalon_params::ignored::markdown();
    let found = std::fs::read_to_string(&page).unwrap_or_default();
    assert!(
        found == expected,
        "docs/ignored-parameters.md should be:\n{expected}"
    );
}
