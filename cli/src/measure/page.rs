//! One self-contained HTML page: text, tables and pictures, readable offline and on a phone.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// A picture of a section.
pub struct Picture {
    /// What it shows, for who cannot see it.
    pub alt: String,
    /// png or gif.
    pub kind: &'static str,
    /// The file.
    pub bytes: Vec<u8>,
}

/// A section of the page.
pub struct Section {
    /// For links.
    pub id: String,
    /// The heading.
    pub title: &'static str,
    /// How to read it.
    pub about: &'static str,
    /// The command that makes it.
    pub command: String,
    /// In the order in which they are shown.
    pub pictures: Vec<Picture>,
    /// The tables as the command prints them.
    pub text: String,
}

/// Light and dark by the reader's choice; wide tables scroll in their own box, never the page.
const STYLE: &str = "
:root { color-scheme: light dark; --ink: #22252b; --soft: #5b616b; --paper: #f7f6f3; --card: #fff; --rule: #d6d5d0; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e8e6e1; --soft: #a3a8b0; --paper: #17191d; --card: #202329; --rule: #363a42; }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 16px/1.55 system-ui, sans-serif; }
main, header { max-width: 76rem; margin: 0 auto; padding: 0 1rem; }
h1 { margin: 2rem 0 0.25rem; font-size: 1.8rem; }
h2 { margin: 0 0 0.5rem; font-size: 1.25rem; }
nav ul { display: flex; flex-wrap: wrap; gap: 0.25rem 1rem; margin: 1rem 0; padding: 0; list-style: none; }
a { color: inherit; }
section { margin: 1.25rem 0; padding: 1rem; background: var(--card); border: 1px solid var(--rule); border-radius: 8px; }
p { max-width: 46rem; margin: 0.25rem 0 0.75rem; color: var(--soft); }
code { font-family: ui-monospace, monospace; font-size: 0.9em; overflow-wrap: anywhere; color: var(--ink); }
img { display: block; max-width: 100%; height: auto; margin: 0 auto 0.75rem; border-radius: 4px; background: #f7f6f3; }
pre { margin: 0; padding: 0.75rem; overflow-x: auto; border: 1px solid var(--rule); border-radius: 4px; font: 0.8rem/1.45 \
ui-monospace, monospace; }
summary { cursor: pointer; margin: 0.25rem 0; }
";

/// Tables of more lines are folded away.
const LONG: usize = 40;

/// The page.
pub fn html(processor: &str, sections: &[Section]) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "taut: cost and error, measured" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    h1 { "taut: cost and error, measured" }
                    p {
                        "Written by " code { "taut measure report" } " of version " (env!("CARGO_PKG_VERSION")) " on "
                        (processor) ". Times are thread CPU time; compare those of one table with each other, and tables of \
                        different runs only by their ratios."
                    }
                    nav {
                        ul {
                            @for section in sections { li { a href=(format!("#{}", section.id)) { (section.title) } } }
                        }
                    }
                }
                main { @for section in sections { (part(section)) } }
            }
        }
    };
    page.into_string()
}

fn part(section: &Section) -> Markup {
    let long = section.text.lines().count() > LONG;
    html! {
        section id=(section.id) {
            h2 { (section.title) }
            p { (section.about) " " code { (section.command) } }
            @for picture in &section.pictures {
                img loading="lazy" alt=(picture.alt)
                    src=(format!("data:image/{};base64,{}", picture.kind, STANDARD.encode(&picture.bytes)));
            }
            @if long {
                details { summary { "The table, " (section.text.lines().count()) " lines" } pre tabindex="0" { (section.text) } }
            } @else if !section.text.is_empty() {
                pre tabindex="0" { (section.text) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_holds_everything_and_nothing_gets_out_of_its_place() {
        let section = |text: &str| Section {
            id: "drape".into(),
            title: "One & all",
            about: "a < b",
            command: "taut drape \"<b>\"".into(),
            pictures: vec![Picture { alt: "\"quoted\"".into(), kind: "png", bytes: vec![0, 1, 2, 255] }],
            text: text.into(),
        };
        let page = html("a <script>", &[section("<i>table</i>"), section(&"line\n".repeat(LONG + 1))]);
        assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>"));
        for part in
            ["One &amp; all", "a &lt; b", "data:image/png;base64,AAEC/w==", "&lt;i&gt;table", "a &lt;script&gt;"]
        {
            assert!(page.contains(part), "{part}: {page}");
        }
        assert_eq!(page.matches("<details>").count(), 1, "only the long table is folded");
        // nothing is fetched: it reads offline
        for outside in ["http:", "https:", "src=\"/", "url(", "@import", "<script", "<i>"] {
            assert!(!page.contains(outside), "{outside}");
        }
    }
}
