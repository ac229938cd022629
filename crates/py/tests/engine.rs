//! The identity of the engine follows its sources, and nothing else.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

#[path = "../build/engine.rs"]
mod engine;

use engine::Sources;
use std::fs;
use std::path::{Path, PathBuf};

const LOCK: &str = r#"version = 4

[[package]]
name = "agent-economy-benchmarks"
version = "0.1.0"
dependencies = [
 "agent-economy-sim",
 "criterion",
]

[[package]]
name = "agent-economy-sim"
version = "0.1.0"
dependencies = [
 "libm",
]

[[package]]
name = "criterion"
version = "0.8.0"
checksum = "c0"

[[package]]
name = "libm"
version = "0.2.15"
checksum = "f1"
"#;

/// A small workspace of its own for each test.
struct Workspace(PathBuf);

impl Workspace {
    fn new(name: &str) -> Self {
        let workspace = Self(Path::new(env!("CARGO_TARGET_TMPDIR")).join(name));
        let _ = fs::remove_dir_all(&workspace.0);
        for name in [
            "base", "brain", "classic", "derive", "economy", "py", "select", "sim",
        ] {
            workspace.write(&format!("crates/{name}/Cargo.toml"), "[package]\n");
            workspace.write(&format!("crates/{name}/src/lib.rs"), "mod run;\n");
            workspace.write(&format!("crates/{name}/src/run/mod.rs"), "fn run() {}\n");
        }
        workspace.write("python/agent_economy/api.py", "x = 1\n");
        workspace.write("Cargo.lock", LOCK);
        workspace
    }

    fn write(&self, path: &str, content: &str) {
        let path = self.0.join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }

    fn hash(&self) -> String {
        Sources::read(&self.0).unwrap().hash()
    }
}

#[test]
fn it_is_sixteen_hexadecimal_digits_and_the_same_for_each_path_of_a_checkout() {
    let hash = Workspace::new("here").hash();
    assert_eq!(hash, Workspace::new("there").hash());
    assert_eq!(hash.len(), 16);
    assert!(hash.bytes().all(|digit| digit.is_ascii_hexdigit()));
}

#[test]
fn it_changes_with_each_crate_that_computes_runs() {
    let workspace = Workspace::new("changed");
    let mut seen = vec![workspace.hash()];
    for name in ["base", "brain", "classic", "derive", "economy", "py", "sim"] {
        for file in ["Cargo.toml", "src/lib.rs", "src/run/mod.rs", "src/new.toml"] {
            workspace.write(&format!("crates/{name}/{file}"), "// changed\n");
            let hash = workspace.hash();
            assert!(!seen.contains(&hash), "{name}/{file}");
            seen.push(hash);
        }
    }
}

#[test]
fn it_does_not_change_with_selection_page_tests_and_python() {
    let workspace = Workspace::new("unchanged");
    let hash = workspace.hash();
    for file in [
        "crates/select/src/lib.rs",
        "crates/sim/tests/golden.rs",
        "crates/sim/src/.lib.rs.swp",
        "python/agent_economy/api.py",
        "web/src/main.ts",
        "Cargo.toml",
    ] {
        workspace.write(file, "changed\n");
        assert_eq!(workspace.hash(), hash, "{file}");
    }
}

#[test]
fn it_changes_when_a_file_moves_or_text_moves_between_files() {
    let workspace = Workspace::new("moved");
    let hash = workspace.hash();
    workspace.write("crates/sim/src/lib.rs", "mod run;\nfn");
    workspace.write("crates/sim/src/run/mod.rs", " run() {}\n");
    let split = workspace.hash();
    fs::remove_file(workspace.0.join("crates/sim/src/run/mod.rs")).unwrap();
    workspace.write("crates/sim/src/run.rs", " run() {}\n");
    assert!(hash != split && split != workspace.hash());
}

#[test]
fn it_does_not_change_with_line_endings() {
    let workspace = Workspace::new("endings");
    let hash = workspace.hash();
    workspace.write("crates/sim/src/lib.rs", "mod run;\r\n");
    workspace.write("Cargo.lock", &LOCK.replace('\n', "\r\n"));
    assert_eq!(workspace.hash(), hash);
}

#[test]
fn it_changes_with_a_dependency_of_the_engine_only() {
    let workspace = Workspace::new("dependencies");
    let hash = workspace.hash();
    // What cargo leaves of the file where an sdist is built.
    let end = LOCK.find("[[package]]\nname = \"criterion\"").unwrap();
    let pruned = LOCK[end..].split_once("\n\n").unwrap().1;
    let start = LOCK
        .find("[[package]]\nname = \"agent-economy-sim\"")
        .unwrap();
    let pruned = format!("version = 4\n\n{}{pruned}", &LOCK[start..end]);
    assert!(!pruned.contains("criterion") && pruned.contains("libm"));
    for lock in [&pruned, &LOCK.replace("0.8.0", "0.8.1")] {
        workspace.write("Cargo.lock", lock);
        assert_eq!(workspace.hash(), hash);
    }
    for (from, to) in [("0.2.15", "0.2.16"), ("f1", "f2")] {
        workspace.write("Cargo.lock", &LOCK.replace(from, to));
        assert_ne!(workspace.hash(), hash);
    }
}

#[test]
fn a_missing_crate_is_named() {
    let workspace = Workspace::new("missing");
    fs::remove_dir_all(workspace.0.join("crates/sim")).unwrap();
    let error = Sources::read(&workspace.0).err().unwrap().to_string();
    assert!(error.contains("sim/Cargo.toml"), "{error}");
}
