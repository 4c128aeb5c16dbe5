//! The C snippet of the README compiles, runs, and is the one in docs/snippet.c.

use crate::drape::denim;
use crate::library::{Language, root, run_all};

#[test]
fn the_snippet_compiles_and_drapes() {
    let folder = tempfile::tempdir().unwrap();
    let main = folder.path().join("main.c");
    std::fs::write(&main, MAIN).unwrap();
    let printed = run_all(Language::C11, &[root().join("docs/snippet.c"), main], &[denim()]);
    assert_eq!(printed, "60 frames, 2 pins\n");
}

/// Calls what the snippet defines.
const MAIN: &str = r#"
#include <stdio.h>
#include "taut.h"

taut_result make_cloth(const void *field_file, size_t size, taut_cloth **out);

int main(int argc, char **argv)
{
    static unsigned char bytes[64 * 1024];
    FILE *file = argc == 2 ? fopen(argv[1], "rb") : NULL;
    if (!file) return 2;
    size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    taut_cloth *cloth;
    if (make_cloth(bytes, size, &cloth) != TAUT_OK) return 1;
    uint32_t flags, pins;
    uint64_t frames;
    if (taut_cloth_step_many(cloth, 60, &flags) != TAUT_OK || flags != 0) return 1;
    if (taut_cloth_step_index(cloth, &frames) != TAUT_OK) return 1;
    if (taut_cloth_pin_count(cloth, &pins) != TAUT_OK) return 1;
    printf("%d frames, %d pins\n", (int)frames, (int)pins);
    return 0;
}
"#;

#[test]
fn the_readme_shows_that_very_text() {
    let snippet = std::fs::read_to_string(root().join("docs/snippet.c")).unwrap();
    assert!(snippet.lines().count() <= 30);
    // before there is a README there is nothing to compare
    let Ok(readme) = std::fs::read_to_string(root().join("README.md")) else {
        return;
    };
    if readme.contains("```c\n") {
        assert!(readme.contains(&format!("```c\n{}\n```", snippet.trim_end())), "README.md must show docs/snippet.c");
    }
}
