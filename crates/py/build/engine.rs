//! The identity of the engine: a hash of all that decides the outcome of a run.
//!
//! It is the same on every machine, for every checkout path, and in an sdist: neither line endings
//! nor the parts of `Cargo.lock` and of the workspace that an sdist lacks are part of it.

#[path = "../../base/src/hash.rs"]
#[expect(unreachable_pub, reason = "public in its crate")]
mod hash;

use hash::Hash;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::{fs, io};

/// The crates that compute runs. Selection, page and Python decide which runs, not their outcomes.
const CRATES: [&str; 7] = ["base", "brain", "classic", "derive", "economy", "py", "sim"];

const LOCK: &str = "Cargo.lock";

/// The folders and files that the identity depends on, relative to the root of the workspace.
pub(crate) fn watched() -> Vec<String> {
    let of = |name| {
        [
            format!("crates/{name}/Cargo.toml"),
            format!("crates/{name}/src"),
        ]
    };
    let crates = CRATES.into_iter().flat_map(of);
    crates.chain([LOCK.to_owned()]).collect()
}

/// The sources of the engine.
pub(crate) struct Sources {
    /// The content of each file, by its path relative to the root, with `/`.
    files: BTreeMap<String, Vec<u8>>,
    /// The packages that the crates use.
    packages: BTreeSet<String>,
}

impl Sources {
    /// Reads them; `root` is the folder of the workspace.
    ///
    /// # Errors
    /// If a file cannot be read.
    pub(crate) fn read(root: &Path) -> io::Result<Self> {
        let mut files = BTreeMap::new();
        for path in watched() {
            read_into(&mut files, root, &path)?;
        }
        let lock = files.remove(LOCK).unwrap_or_default();
        let packages = used_packages(&String::from_utf8_lossy(&lock));
        Ok(Self { files, packages })
    }

    /// Their hash: 16 hexadecimal digits.
    pub(crate) fn hash(&self) -> String {
        let mut hash = Hash::new();
        for (path, content) in &self.files {
            add(&mut hash, path.as_bytes());
            add(&mut hash, content);
        }
        for package in &self.packages {
            add(&mut hash, package.as_bytes());
        }
        format!("{:016x}", hash.value())
    }
}

/// Reads a file, or all files of a folder but hidden ones, which editors leave.
fn read_into(files: &mut BTreeMap<String, Vec<u8>>, root: &Path, path: &str) -> io::Result<()> {
    let file = root.join(path);
    if !file.is_dir() {
        let content = fs::read(&file)
            .map_err(|why| io::Error::new(why.kind(), format!("{}: {why}", file.display())))?;
        files.insert(path.to_owned(), with_line_feeds(content));
        return Ok(());
    }
    for entry in fs::read_dir(&file)? {
        let name = entry?.file_name();
        let name = name.to_string_lossy();
        if !name.starts_with('.') {
            read_into(files, root, &format!("{path}/{name}"))?;
        }
    }
    Ok(())
}

/// Some checkouts have other line endings.
fn with_line_feeds(mut content: Vec<u8>) -> Vec<u8> {
    content.retain(|byte| *byte != b'\r');
    content
}

/// Adds bytes, preceded by their number, so that no two sequences of parts are the same words.
fn add(hash: &mut Hash, bytes: &[u8]) {
    hash.add(bytes.len() as u64);
    for chunk in bytes.chunks(8) {
        let mut word = [0; 8];
        word[..chunk.len()].copy_from_slice(chunk);
        hash.add(u64::from_le_bytes(word));
    }
}

/// A package of `Cargo.lock`.
struct Package<'a> {
    name: &'a str,
    version: &'a str,
    checksum: &'a str,
    /// Their names, followed by a version where several packages have the name.
    dependencies: Vec<&'a str>,
}

/// The packages of `Cargo.lock` that the crates use, directly or not: cargo removes the others when an
/// sdist, which lacks the benchmarks, is built.
fn used_packages(lock: &str) -> BTreeSet<String> {
    let packages: Vec<Package> = lock.split("[[package]]").skip(1).map(package).collect();
    let own = CRATES.map(|name| format!("agent-economy-{name}"));
    let mut wanted: Vec<&str> = own.iter().map(String::as_str).collect();
    let mut used = BTreeSet::new();
    while let Some(dependency) = wanted.pop() {
        for package in packages.iter().filter(|package| package.is(dependency)) {
            if used.insert(format!(
                "{} {} {}",
                package.name, package.version, package.checksum
            )) {
                wanted.extend(&package.dependencies);
            }
        }
    }
    used
}

fn package(text: &str) -> Package<'_> {
    let value = |key: &str| {
        let line = text.lines().find_map(|line| line.strip_prefix(key));
        line.unwrap_or_default().trim_matches(['=', ' ', '"'])
    };
    let listed = text
        .lines()
        .filter_map(|line| line.strip_prefix(" \"")?.strip_suffix("\","));
    Package {
        name: value("name "),
        version: value("version "),
        checksum: value("checksum "),
        dependencies: listed.collect(),
    }
}

impl Package<'_> {
    fn is(&self, dependency: &str) -> bool {
        let mut words = dependency.split(' ');
        words.next() == Some(self.name)
            && words.next().is_none_or(|version| version == self.version)
    }
}
