//! Imports of one Rust file, the paths that its code names, and the lengths of its functions.

use proc_macro2::Span;
use syn::punctuated::Punctuated;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Attribute, Expr, ImplItem, Item, Signature, Token, UseTree, Visibility};

/// A path as written, `crate`, `self` and `super` included, seen from the file's own module.
pub type Path = Vec<String>;

#[derive(Debug, PartialEq)]
pub struct Use {
    pub path: Path,
    /// The name in this file; "*" for a glob.
    pub name: String,
    pub public: bool,
}

#[derive(Debug, Default)]
pub struct Source {
    pub uses: Vec<Use>,
    /// Every path of two or more segments outside of imports.
    pub paths: Vec<Path>,
    /// Name of every function with a body, and its lines from `fn` to the closing brace.
    pub functions: Vec<(String, usize)>,
    skips_tests: bool,
    /// Inline modules around the place that is being visited.
    inline_modules: usize,
}

impl Source {
    /// Parses a file. Items under `#[cfg(test)]` are left out unless `with_tests`.
    pub fn parse(text: &str, with_tests: bool) -> syn::Result<Source> {
        let mut source = Source { skips_tests: !with_tests, ..Source::default() };
        source.visit_file(&syn::parse_file(text)?);
        Ok(source)
    }

    fn skips(&self, attributes: &[Attribute]) -> bool {
        let is_test =
            |a: &Attribute| a.path().is_ident("cfg") && a.parse_args::<syn::Path>().is_ok_and(|p| p.is_ident("test"));
        self.skips_tests && attributes.iter().any(is_test)
    }

    fn add_function(&mut self, signature: &Signature, end: Span) {
        let lines = end.end().line - signature.fn_token.span().start().line + 1;
        self.functions.push((signature.ident.to_string(), lines));
    }

    fn add_uses(&mut self, tree: &UseTree, before: &[String], public: bool) {
        let joined = |name: &syn::Ident| before.iter().cloned().chain([name.to_string()]).collect::<Path>();
        let whole = |name: &syn::Ident| if name == "self" { before.to_vec() } else { joined(name) };
        let (path, name) = match tree {
            UseTree::Path(tree) => return self.add_uses(&tree.tree, &joined(&tree.ident), public),
            UseTree::Group(tree) => return tree.items.iter().for_each(|tree| self.add_uses(tree, before, public)),
            UseTree::Name(tree) => {
                let path = whole(&tree.ident);
                let name = path.last().cloned().unwrap_or_default();
                (path, name)
            }
            UseTree::Rename(tree) => (whole(&tree.ident), tree.rename.to_string()),
            UseTree::Glob(_) => (before.to_vec(), "*".to_owned()),
        };
        let path = self.seen_from_the_file(path);
        self.uses.push(Use { path, name, public });
    }

    /// Takes one `super` off a path for each inline module around it.
    fn seen_from_the_file(&self, mut path: Path) -> Path {
        for _ in 0..self.inline_modules {
            match path.first().map(String::as_str) {
                Some("super") if path.get(1).is_some_and(|p| p == "super") => drop(path.remove(0)),
                Some("super") => path[0] = "self".into(),
                _ => break,
            }
        }
        path
    }
}

impl<'ast> Visit<'ast> for Source {
    fn visit_item(&mut self, item: &'ast Item) {
        if !self.skips(attributes(item)) {
            visit::visit_item(self, item);
        }
    }

    fn visit_impl_item(&mut self, item: &'ast ImplItem) {
        let attributes = match item {
            ImplItem::Const(item) => item.attrs.as_slice(),
            ImplItem::Fn(item) => &item.attrs,
            ImplItem::Type(item) => &item.attrs,
            _ => &[],
        };
        if !self.skips(attributes) {
            visit::visit_impl_item(self, item);
        }
    }

    fn visit_item_mod(&mut self, module: &'ast syn::ItemMod) {
        self.inline_modules += 1;
        visit::visit_item_mod(self, module);
        self.inline_modules -= 1;
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        self.add_uses(&item.tree, &[], !matches!(item.vis, Visibility::Inherited));
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        if path.segments.len() > 1 {
            let path = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
            self.paths.push(self.seen_from_the_file(path));
        }
        visit::visit_path(self, path);
    }

    /// The paths in a macro's brackets count where they read as expressions, as those of `assert!` do.
    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        visit::visit_macro(self, call);
        if let Ok(arguments) = call.parse_body_with(Punctuated::<Expr, Token![,]>::parse_terminated) {
            // The parsed expressions live no longer than this call.
            let mut inner =
                Source { skips_tests: self.skips_tests, inline_modules: self.inline_modules, ..Source::default() };
            arguments.iter().for_each(|argument| inner.visit_expr(argument));
            self.paths.append(&mut inner.paths);
        }
    }

    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        self.add_function(&item.sig, item.block.span());
        visit::visit_item_fn(self, item);
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        self.add_function(&item.sig, item.block.span());
        visit::visit_impl_item_fn(self, item);
    }

    fn visit_trait_item_fn(&mut self, item: &'ast syn::TraitItemFn) {
        if let Some(block) = &item.default {
            self.add_function(&item.sig, block.span());
        }
        visit::visit_trait_item_fn(self, item);
    }
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

#[test]
fn functions_are_measured() {
    let text = "fn one() {\n    two();\n}\n\nimpl A {\n    pub fn three(\n        &self,\n    ) -> u8 {\n        fn four() {\n        }\n    }\n}\ntrait B {\n    fn five(&self);\n    fn six() {}\n}\n";
    let found = Source::parse(text, true).unwrap().functions;
    let expected = [("one", 3), ("three", 6), ("four", 2), ("six", 1)];
    assert_eq!(found, expected.map(|(name, lines)| (name.to_owned(), lines)));
}
