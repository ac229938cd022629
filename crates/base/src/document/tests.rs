use super::*;
use proptest::prelude::*;

fn errors_of(text: &str, reader: impl FnOnce(&Section) -> Option<()>) -> Vec<String> {
    let document = match Document::parse("job.toml", text) {
        Ok(document) => document,
        Err(errors) => return errors.0.iter().map(ToString::to_string).collect(),
    };
    match document.read(reader) {
        Ok(()) => Vec::new(),
        Err(errors) => errors.0.iter().map(ToString::to_string).collect(),
    }
}

#[test]
fn all_errors_are_reported_at_once_with_their_lines() {
    let text = "engine = \"clasic\"\ntime_limit_s = \"long\"\n\n[robots.rover]\ncuont = 3\n";
    let errors = errors_of(text, |root| {
        root.only(&["engine", "time_limit_s", "robots"]);
        let engine = root.choice("engine", &[("classic", 1), ("metric", 2)]);
        let time_limit_s = root.number("time_limit_s", 0.0..=10.0);
        let rover = root.section("robots").section("rover");
        rover.only(&["count"]);
        let count = rover.integer("count", 1..=9);
        engine.and(time_limit_s).and(count).map(|_| ())
    });
    assert_eq!(
        errors,
        [
            "job.toml:1: engine = \"clasic\": must be one of \"classic\", \"metric\"; \
             did you mean \"classic\"?",
            "job.toml:2: time_limit_s = \"long\": must be a number from 0 to 10",
            "job.toml:5: robots.rover.cuont is not a known key: expected one of count; \
             did you mean count?",
            "job.toml:4: robots.rover.count is missing: expected a whole number from 1 to 9",
        ]
    );
}

#[test]
fn invalid_toml_is_reported_with_its_line() {
    let errors = errors_of("a = 1\nb = = 2\n", |_| Some(()));
    assert!(!errors.is_empty());
    for error in errors {
        assert!(error.starts_with("job.toml:2: not valid TOML: "), "{error}");
    }
}

#[test]
fn nan_and_numbers_beyond_64_bits_are_out_of_every_range() {
    let text = "a = nan\nb = 99999999999999999999\nc = 1979-05-27";
    let errors = errors_of(text, |root| {
        let a = root.number("a", f64::MIN..=f64::MAX);
        let b = root.integer("b", i64::MIN..=i64::MAX);
        let c = root.line("c");
        a.and(b).and(c).map(|_| ())
    });
    assert_eq!(errors.len(), 3, "{errors:?}");
}

#[test]
fn a_table_instead_of_a_value_and_the_reverse_are_errors() {
    let errors = errors_of("a = 1\n[b]\nc = 1", |root| {
        let a = root.section("a").integer("x", 0..=1);
        let b = root.integer("b", 0..=1);
        a.and(b).map(|_| ())
    });
    assert_eq!(
        errors,
        [
            "job.toml:1: a = 1: must be a table",
            "job.toml:2: b = {...}: must be a whole number from 0 to 1",
        ]
    );
}

#[test]
fn each_invalid_number_of_a_list_is_reported_with_its_index() {
    let errors = errors_of("a = [1, 20, \"x\"]\nb = []", |root| {
        let a = root.numbers("a", 0.0..=10.0);
        let b = root.numbers("b", 0.0..=10.0);
        a.and(b).map(|_| ())
    });
    assert_eq!(
        errors,
        [
            "job.toml:1: a[1] = 20: must be a number from 0 to 10",
            "job.toml:1: a[2] = \"x\": must be a number from 0 to 10",
            "job.toml:2: b = []: must be a list of at least one number",
        ]
    );
}

#[test]
fn a_line_is_neither_empty_nor_broken() {
    for text in ["''", "' '", r#""a\nb""#, r#""\u2028""#, r#""\u0000""#] {
        let errors = errors_of(&format!("a = {text}"), |root| root.line("a").map(|_| ()));
        assert_eq!(errors.len(), 1, "{text}");
        assert!(
            errors[0].ends_with("must be a non-empty string of one line"),
            "{errors:?}"
        );
    }
}

#[test]
fn an_option_overrides_the_file_and_is_named_in_its_error() {
    let mut document = Document::parse("job.toml", "[robots]\ncount = 3").unwrap();
    document.set(&["robots", "count"], Value::Integer(0), "--count");
    let read = |root: &Section| root.section("robots").integer("count", 1..=9);
    let errors = document.read(read).unwrap_err();
    assert_eq!(
        errors.to_string(),
        "--count: robots.count = 0: must be a whole number from 1 to 9"
    );
    document.set(&["robots", "count"], Value::Integer(5), "--count");
    assert_eq!(document.read(read), Ok(5));
}

proptest! {
    #[test]
    fn any_string_is_parsed_or_rejected_without_a_panic(text in "[a-c=\\[\\]\"'.0-9\n{}, #_-]{0,60}") {
        let _ = Document::parse("fuzz", &text).map(|document| {
            document.read(|root| {
                root.only(&["a"]);
                let _ = root.section("a").number("b", 0.0..=1.0);
                let _ = root.section("b").numbers("c", 0.0..=1.0);
                Some(())
            })
        });
    }
}

#[test]
fn tables_are_known_that_were_made_for_a_value_in_them() {
    let mut document = Document::parse("job.toml", "[robots.rover]\ncount = 2").unwrap();
    for path in [
        &["robots", "rover", "drive"][..],
        &["robots", "scout", "drive", "speed"],
        &["robots", "scout", "count"],
    ] {
        document.set(path, Value::Integer(1), "--set");
    }
    let created = document.created_tables().iter();
    let created: Vec<_> = created
        .map(|table| (table.path.join("."), table.place))
        .collect();
    assert_eq!(created, [("robots.scout.drive.speed".to_owned(), 1)]);
}

#[test]
fn a_value_that_is_varied_keeps_the_documents_own() {
    let mut document = Document::parse("job.toml", "[items.mine]\ncount = 12").unwrap();
    let path = ["items", "mine", "count"];
    for value in 1..3 {
        document.vary(&path, Value::Integer(value), "study.vary");
        document.vary(
            &["items", "mine", "target"],
            Value::Bool(true),
            "study.vary",
        );
        assert_eq!(document.get(&path).unwrap().value, Value::Integer(value));
    }
    assert_eq!(document.own(&path), Some(&Value::Integer(12)));
    assert_eq!(document.own(&["items", "mine", "target"]), None);
    document.set(&["clock"], Value::Integer(1), "--set");
    assert_eq!(document.own(&["clock"]), Some(&Value::Integer(1)));
}

#[test]
fn what_stands_at_a_path_is_found_with_its_line() {
    let document = Document::parse("job.toml", "[a]\n\"b.c\" = 3\nd = 1").unwrap();
    let node = document.get(&["a", "b.c"]).unwrap();
    assert_eq!(
        (&node.value, node.origin.as_str()),
        (&Value::Integer(3), "job.toml:2")
    );
    assert_eq!(document.get(&["a", "b", "c"]), None);
    assert_eq!(document.get(&["a", "d", "e"]), None);
}

#[test]
fn an_invalid_number_is_reported_with_what_is_allowed() {
    let read = |text: &str| {
        errors_of(text, |root| {
            root.number_if("a", "a number above 0", |a| a > 0.0)
                .map(|_| ())
        })
    };
    assert!(read("a = 1").is_empty());
    for (text, given) in [
        ("a = 0", "a = 0"),
        ("a = inf", "a = inf"),
        ("a = '1'", "a = \"1\""),
    ] {
        assert_eq!(
            read(text),
            [format!("job.toml:1: {given}: must be a number above 0")]
        );
    }
    assert_eq!(
        read("b = 1"),
        ["job.toml: a is missing: expected a number above 0"]
    );
}

#[test]
fn what_is_filled_in_gives_way_to_what_is_there_and_keeps_its_own_line() {
    let mut document = Document::parse("job", "[a.drive]\nspeed = 1\n[a]\nlist = [1]\nb = 2");
    let document = document.as_mut().unwrap();
    let defaults = "radius = 1\nlist = [2, 3]\n[drive]\nspeed = 5\nturn = 6\n[b]\nc = 1";
    document.fill(&["a"], &Document::parse("model", defaults).unwrap());
    let at = |path: &[&str]| {
        let node = document.get(path).unwrap();
        (node.value.to_string(), node.origin.as_str())
    };
    assert_eq!(at(&["a", "drive", "speed"]), ("1".to_owned(), "job:2"));
    assert_eq!(at(&["a", "drive", "turn"]), ("6".to_owned(), "model:5"));
    assert_eq!(at(&["a", "radius"]), ("1".to_owned(), "model:1"));
    assert_eq!(at(&["a", "list"]), ("[1]".to_owned(), "job:4"));
    assert_eq!(at(&["a", "b"]), ("2".to_owned(), "job:5"));
}

#[test]
fn a_table_of_another_kind_is_not_filled_in() {
    let mut document = Document::parse("job", "[eye]\nkind = \"items\"\n[ear]\n").unwrap();
    let defaults = "[eye]\nkind = \"range\"\nrays = 3\n[ear]\nkind = \"robots\"";
    document.fill(&[], &Document::parse("model", defaults).unwrap());
    assert_eq!(document.get(&["eye", "rays"]), None);
    assert!(document.get(&["ear", "kind"]).is_some());
}
