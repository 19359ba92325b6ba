// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Checks that include/ccd/warm.h and paper.h are those that cbindgen generates from src/ffi.
//!
//! cbindgen sorts the items of a file: macros, structs, functions. For a better order each section of
//! a header is a file, whose first comment is the section's heading.
//!
//! `WRITE_HEADER=1 cargo test --test integration header::` writes the headers.

use std::path::Path;

/// Each header with what it includes and the files of src/ffi that are its sections. Its head is in a file of its name.
const HEADERS: [(&str, &str, &str); 2] = [
    (
        "warm",
        "ccd/ccd.h",
        "warm/codes warm/state warm/want warm/penetration warm/intersect warm/distance warm/contacts warm/special warm/libccd \
         warm/check warm/identity",
    ),
    ("paper", "ccd/warm.h", "paper"),
];

/// Converts a file's first comment to C.
fn heading(source: &str) -> String {
    let lines = source.lines().filter_map(|line| line.strip_prefix("//!"));
    let text = lines.collect::<Vec<_>>().join("\n *");
    format!("/*{text} */\n")
}

/// Runs cbindgen on a file, without a frame. Adds parentheses to negative macros.
fn section(path: &Path) -> String {
    let mut config = cbindgen::Config {
        language: cbindgen::Language::C,
        sys_includes: vec![],
        includes: vec![],
        no_includes: true,
        documentation_style: cbindgen::DocumentationStyle::Doxy,
        usize_is_size_t: true,
        line_length: 100,
        style: cbindgen::Style::Both,
        ..Default::default()
    };
    config.function.prefix = Some("CCD_EXPORT".into());
    config.function.args = cbindgen::Layout::Auto;
    config.export.rename.insert("Real".into(), "ccd_real_t".into());
    let mut out = Vec::new();
    cbindgen::Builder::new().with_config(config).with_src(path).generate().expect("cbindgen").write(&mut out);
    let text = String::from_utf8(out).expect("UTF-8");
    // A type has one name in every file.
    let text = text.replace(" struct ccd_", " ccd_").replace("(struct ccd_", "(ccd_");
    let text = text.replace("typedef ccd_", "typedef struct ccd_");
    // A callback of ccd.h may be NULL, as every pointer to a function in C.
    let (text, mut declared) = (text.replace("struct Option_ccd_", "ccd_"), false);
    let text = text.lines().filter(|line| {
        let skip = line.contains(" Option_ccd_") || declared && line.is_empty();
        declared = skip;
        !skip
    });
    let text = text.collect::<Vec<_>>().join("\n");
    let lines = text.trim().lines().map(|line| {
        let macro_value = line.strip_prefix("#define ").and_then(|l| l.split_once(" -"));
        match macro_value {
            Some((name, value)) => format!("#define {name} (-{value})"),
            None => line.to_owned(),
        }
    });
    lines.collect::<Vec<_>>().join("\n") + "\n"
}

fn generated(root: &Path, name: &str, included: &str, sections: &str) -> String {
    let path = |file: &str| root.join(format!("src/ffi/{file}.rs"));
    let heading_of = |file: &str| heading(&std::fs::read_to_string(path(file)).expect(file));
    let guard = format!("__CCD_{}_H__", name.to_uppercase());
    let mut text = format!(
        "/* SPDX-FileCopyrightText: 2026 The warmccd developers\n \
         * SPDX-License-Identifier: BSD-3-Clause */\n\n\
         {}\n#ifndef {guard}\n#define {guard}\n\n#include <{included}>\n\n\
         #ifdef __cplusplus\nextern \"C\" {{\n#endif\n",
        heading_of(name),
    );
    for file in sections.split(' ') {
        if file != name {
            text += "\n\n";
            text += &heading_of(file);
        }
        text += "\n";
        text += &section(&path(file));
    }
    text + &format!("\n#ifdef __cplusplus\n}}\n#endif\n\n#endif /* {guard} */\n")
}

/// Checks that include/README.md has every call of the headers as it is declared there.
#[test]
fn the_page_has_every_signature() {
    let include = Path::new(env!("CARGO_MANIFEST_DIR")).join("include");
    let read = |name: &str| std::fs::read_to_string(include.join(name)).expect(name);
    let page = read("README.md");
    let mut calls = 0;
    for header in ["ccd/ccd.h", "ccd/warm.h", "ccd/paper.h"] {
        let text = read(header).split_whitespace().collect::<Vec<_>>().join(" ");
        for declared in text.split("CCD_EXPORT ").skip(1) {
            let declared = declared.split_once(';').expect("a declaration").0;
            let signature = &declared[declared.find("ccd").expect("a name")..];
            let signature = signature.replace("const void *obj1, const void *obj2, const ccd_t *ccd", "…");
            let signature = signature.replace("unsigned int", "unsigned");
            let is_callback = signature.starts_with("ccdFirstDirDefault");
            assert!(is_callback || page.contains(&format!("`{signature}`")), "{header}: {signature}");
            calls += 1;
        }
    }
    assert!(calls >= 20, "{calls}");
}

#[test]
fn headers_match_the_source() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (name, included, sections) in HEADERS {
        let path = root.join(format!("include/ccd/{name}.h"));
        let generated = generated(root, name, included, sections);
        if std::env::var_os("WRITE_HEADER").is_some() {
            std::fs::write(&path, &generated).expect("write the header");
        }
        let committed = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(committed == generated, "{name}.h is stale: WRITE_HEADER=1 cargo test --test integration header::");
    }
}
