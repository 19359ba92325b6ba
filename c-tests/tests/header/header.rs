// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! include/ccd/warm.h and paper.h are what cbindgen makes of src/ffi: no drift.
//!
//! cbindgen sorts what it finds in a file: macros, structs, functions. So that the header reads
//! from the top, each of its sections is a file of its own, whose first comment is the section's
//! heading.
//!
//! `WRITE_HEADER=1 cargo test --test header` writes them anew.

use std::path::Path;

/// The files of src/ffi that a header is made of: its head, and its sections in their order.
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

/// A file's first comment as one of C.
fn heading(source: &str) -> String {
    let lines = source.lines().filter_map(|line| line.strip_prefix("//!"));
    let text = lines.collect::<Vec<_>>().join("\n *");
    format!("/*{text} */\n")
}

/// What cbindgen makes of a file, without a frame. Negative macros get their parentheses.
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
    let made = String::from_utf8(out).expect("UTF-8");
    // A type is called by one name, in whatever file it is.
    let made = made.replace(" struct ccd_", " ccd_").replace("(struct ccd_", "(ccd_");
    let made = made.replace("typedef ccd_", "typedef struct ccd_");
    // A pointer to a function of a type of ccd.h's may be NULL, as every such one in C.
    let (made, mut declared) = (made.replace("struct Option_ccd_", "ccd_"), false);
    let made = made.lines().filter(|line| {
        let skip = line.contains(" Option_ccd_") || declared && line.is_empty();
        declared = skip;
        !skip
    });
    let made = made.collect::<Vec<_>>().join("\n");
    let lines = made.trim().lines().map(|line| {
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
fn headers_are_what_the_source_says() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for header in &HEADERS {
        let path = root.join("include/ccd").join(header.name);
        let fresh = generated(root, header);
        if std::env::var_os("WRITE_HEADER").is_some() {
            std::fs::write(&path, &fresh).expect("write the header");
        }
        let committed = std::fs::read_to_string(&path).unwrap_or_default();
        let name = header.name;
        assert!(committed == fresh, "{name} is stale: WRITE_HEADER=1 cargo test --test header");
    }
}
