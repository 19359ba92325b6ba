// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Checks that include/ccd/warm.h and paper.h are those that cbindgen generates from src/ffi.
//!
//! cbindgen sorts the items of a file: macros, structs, functions. For a better order each section of
//! a header is a file, whose first comment is the section's heading.
//!
//! `WRITE_HEADER=1 cargo test --test integration header::` writes the headers.

use std::path::Path;

/// Header and the files of src/ffi that it is generated from: its head and its sections.
struct Header {
    name: &'static str,
    guard: &'static str,
    includes: &'static str,
    head: &'static str,
    sections: &'static [&'static str],
}

const HEADERS: [Header; 2] = [
    Header {
        name: "warm.h",
        guard: "__CCD_WARM_H__",
        includes: "#include <ccd/ccd.h>",
        head: "warm.rs",
        sections: &[
            "warm/codes.rs",
            "warm/state.rs",
            "warm/penetration.rs",
            "warm/intersect.rs",
            "warm/distance.rs",
            "warm/contacts.rs",
            "warm/special.rs",
            "warm/libccd.rs",
            "warm/check.rs",
            "warm/identity.rs",
        ],
    },
    Header {
        name: "paper.h",
        guard: "__CCD_PAPER_H__",
        includes: "#include <ccd/warm.h>",
        head: "paper.rs",
        sections: &["paper.rs"],
    },
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

fn generated(root: &Path, header: &Header) -> String {
    let ffi = root.join("src/ffi");
    let read = |file: &str| std::fs::read_to_string(ffi.join(file)).expect(file);
    let guard = header.guard;
    let mut text = format!(
        "/* SPDX-FileCopyrightText: 2026 The warmccd developers\n \
         * SPDX-License-Identifier: BSD-3-Clause */\n\n\
         {}\n#ifndef {guard}\n#define {guard}\n\n{}\n\n\
         #ifdef __cplusplus\nextern \"C\" {{\n#endif\n",
        heading(&read(header.head)),
        header.includes
    );
    for file in header.sections {
        if *file != header.head {
            text += "\n\n";
            text += &heading(&read(file));
        }
        text += "\n";
        text += &section(&ffi.join(file));
    }
    text + &format!("\n#ifdef __cplusplus\n}}\n#endif\n\n#endif /* {guard} */\n")
}

#[test]
fn headers_match_the_source() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for header in &HEADERS {
        let path = root.join("include/ccd").join(header.name);
        let generated = generated(root, header);
        if std::env::var_os("WRITE_HEADER").is_some() {
            std::fs::write(&path, &generated).expect("write the header");
        }
        let committed = std::fs::read_to_string(&path).unwrap_or_default();
        let name = header.name;
        assert!(committed == generated, "{name} is stale: WRITE_HEADER=1 cargo test --test integration header::");
    }
}
