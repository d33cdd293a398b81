//! Links from page to page.

use super::pages::root;

/// The anchor of a heading, as GitHub names it.
fn anchor(heading: &str) -> String {
    let kept = heading.trim_start_matches('#').trim().to_lowercase();
    kept.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c)).map(|c| if c == ' ' { '-' } else { c }).collect()
}

#[test]
fn every_link_between_pages_leads_somewhere() {
    for page in super::all() {
        let text = std::fs::read_to_string(root().join(&page.name)).unwrap();
        let folder = root().join(&page.name).parent().unwrap().to_owned();
        let links = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        for link in links.filter(|link| !link.contains("://") && !link.contains(' ')) {
            let (path, wanted) = link.split_once('#').unwrap_or((link, ""));
            let target = if path.is_empty() { root().join(&page.name) } else { folder.join(path) };
            assert!(target.exists(), "{}: {link}", page.name);
            let has = |text: &str| text.lines().any(|line| line.starts_with('#') && anchor(line) == wanted);
            assert!(wanted.is_empty() || has(&std::fs::read_to_string(&target).unwrap()), "{}: {link}", page.name);
        }
    }
}
