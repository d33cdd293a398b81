//! Names: constants with a noun, one public type a name, short test names, no vague pronoun in a comment.

use super::imports::rust_files;
use super::root;
use crate::prelude::*;
use proc_macro2::TokenTree;
use syn::visit::Visit;
use syn::{Attribute, Ident, Visibility, visit};

/// Constants of one of these words alone lack the noun and its unit.
const BARE_NAMES: &str = "AFTER ALIKE ALIVE APART AROUND ASKED BEFORE BEFOREHAND COARSE DEEPEST EACH EVERY FAR FARTHEST FEW \
                          FEWEST FINE FROM GOLDEN JUDGED KEPT LARGE LARGEST LEAST LIMIT LONGEST MANY MAX MIN MOST NARROW NEAR \
                          OVER PADDED POOLED RANDOM RESTART ROUND SAID SHORT SMALLEST TO TOLD WIDE";
const VAGUE_PRONOUNS: [&str; 6] = ["anybody", "everybody", "nobody", "somebody", "whatever", "whoever"];
const MAX_TEST_NAME_LETTERS: usize = 60;
/// Every subcommand has one.
const NAMES_OF_SUBCOMMANDS: [&str; 1] = ["Args"];
/// Rooms whose public types may share names with other rooms'.
const EXEMPT_ROOMS: [&str; 7] = [
    "src/app/",
    "src/recording/",
    "src/reconstruct/coherent/",
    "src/reconstruct/fit/",
    "src/reconstruct/hybrid.rs",
    "src/reconstruct/judge.rs",
    "src/reconstruct/search/",
];

#[derive(Default)]
pub struct Names {
    constants: Vec<(String, usize)>,
    public_types: Vec<(String, usize)>,
    pub tests: Vec<(String, usize)>,
    pub ignored: BTreeSet<String>,
}

impl Names {
    pub fn of(text: &str) -> Names {
        let mut names = Names::default();
        names.visit_file(&syn::parse_file(text).unwrap());
        names
    }

    fn add_type(&mut self, visibility: &Visibility, name: &Ident) {
        if !matches!(visibility, Visibility::Inherited) {
            self.public_types.push(named(name));
        }
    }
}

fn named(name: &Ident) -> (String, usize) {
    (name.to_string(), name.span().start().line)
}

impl<'ast> Visit<'ast> for Names {
    fn visit_item_const(&mut self, item: &'ast syn::ItemConst) {
        self.constants.push(named(&item.ident));
        visit::visit_item_const(self, item);
    }

    fn visit_impl_item_const(&mut self, item: &'ast syn::ImplItemConst) {
        self.constants.push(named(&item.ident));
    }

    fn visit_item_static(&mut self, item: &'ast syn::ItemStatic) {
        self.constants.push(named(&item.ident));
    }

    fn visit_item_struct(&mut self, item: &'ast syn::ItemStruct) {
        self.add_type(&item.vis, &item.ident);
    }

    fn visit_item_enum(&mut self, item: &'ast syn::ItemEnum) {
        self.add_type(&item.vis, &item.ident);
    }

    fn visit_item_trait(&mut self, item: &'ast syn::ItemTrait) {
        self.add_type(&item.vis, &item.ident);
        visit::visit_item_trait(self, item);
    }

    fn visit_item_type(&mut self, item: &'ast syn::ItemType) {
        self.add_type(&item.vis, &item.ident);
    }

    /// Tests inside of `proptest! { … }` are tokens to the parser: each is a `#[test]`, then a `fn`.
    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        if !call.path.is_ident("proptest") {
            return;
        }
        let tokens: Vec<TokenTree> = call.tokens.clone().into_iter().collect();
        let mut is_test = false;
        for pair in tokens.windows(2) {
            match pair {
                [TokenTree::Punct(_), TokenTree::Group(group)] => is_test |= group.stream().to_string() == "test",
                [TokenTree::Ident(word), TokenTree::Ident(name)] if word == "fn" && is_test => {
                    self.tests.push(named(name));
                    is_test = false;
                }
                _ => {}
            }
        }
    }

    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        let has = |name: &str| item.attrs.iter().any(|a: &Attribute| a.path().is_ident(name));
        if has("test") {
            self.tests.push(named(&item.sig.ident));
        }
        if has("ignore") {
            self.ignored.insert(item.sig.ident.to_string());
        }
        visit::visit_item_fn(self, item);
    }
}

/// Every file that is held to the rules: its path from the project's folder on, and its text.
pub fn held_files() -> Vec<(String, String)> {
    let paths = ["src", "tests", "examples", "fuzz/fuzz_targets", "python/src"].map(|f| rust_files(&root().join(f)));
    let files = paths.concat().into_iter().map(|path| {
        let name = path.strip_prefix(root()).unwrap().display().to_string();
        (name, std::fs::read_to_string(&path).unwrap())
    });
    files.collect()
}

fn assert_none(what: &str, found: &[String]) {
    assert!(found.is_empty(), "{} {what}:\n{}", found.len(), found.join("\n"));
}

#[test]
fn constants_have_a_noun() {
    let bare = held_files().into_iter().flat_map(|(file, text)| {
        let constants =
            Names::of(&text).constants.into_iter().filter(|(name, _)| BARE_NAMES.split(' ').any(|bare| bare == name));
        constants.map(move |(name, line)| format!("{file}:{line}: {name}")).collect::<Vec<_>>()
    });
    assert_none("constants without a noun", &bare.collect::<Vec<_>>());
}

#[test]
fn a_public_type_has_its_name_alone() {
    let mut places: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let is_held =
        |file: &String| file.starts_with("src/") && !EXEMPT_ROOMS.iter().any(|room| Path::new(file).starts_with(room));
    for (file, text) in held_files().into_iter().filter(|(file, _)| is_held(file)) {
        for (name, line) in Names::of(&text).public_types {
            places.entry(name).or_default().push(format!("{file}:{line}"));
        }
    }
    let shared = places.into_iter().filter(|(name, at)| {
        let platforms = at.iter().all(|place| place.starts_with("src/platform/"));
        at.len() > 1 && !platforms && !NAMES_OF_SUBCOMMANDS.contains(&name.as_str())
    });
    let shared: Vec<String> = shared.map(|(name, at)| format!("{name}: {}", at.join(", "))).collect();
    assert_none("names of several public types", &shared);
}

#[test]
fn comments_have_no_vague_pronouns() {
    let mut vague = Vec::new();
    for (file, text) in held_files() {
        for (number, line) in text.lines().enumerate() {
            let comment = line.find("//").map_or("", |at| &line[at..]).to_lowercase();
            let mut words = comment.split(|c: char| !c.is_alphanumeric());
            if words.any(|word| VAGUE_PRONOUNS.contains(&word)) {
                vague.push(format!("{file}:{}: {}", number + 1, line.trim()));
            }
        }
    }
    assert_none("comments with a vague pronoun", &vague);
}

#[test]
fn test_names_are_one_claim() {
    let long = held_files().into_iter().flat_map(|(file, text)| {
        let tests = Names::of(&text).tests.into_iter().filter(|(name, _)| name.len() > MAX_TEST_NAME_LETTERS);
        tests.map(move |(name, line)| format!("{file}:{line}: {name} has {} letters", name.len())).collect::<Vec<_>>()
    });
    assert_none("test names are too long", &long.collect::<Vec<_>>());
}

#[test]
fn names_are_found() {
    let text = "const MOST: u8 = 1;\nimpl A {\n    const LEAST: u8 = 0;\n}\npub struct One;\nenum Two {}\n\
                mod tests {\n    pub(super) struct Three;\n    #[test]\n    fn four() {\n        const MANY: u8 = 2;\n    }\n    proptest! {\n        #[test]\n        fn five(n in 0..2) {}\n    }\n}\n";
    let names = Names::of(text);
    let told =
        |of: Vec<(String, usize)>| of.into_iter().map(|(name, line)| format!("{line} {name}")).collect::<Vec<_>>();
    assert_eq!(told(names.constants), ["1 MOST", "3 LEAST", "11 MANY"]);
    assert_eq!(told(names.public_types), ["5 One", "8 Three"]);
    assert_eq!(told(names.tests), ["10 four", "15 five"]);
}
