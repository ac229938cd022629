//! The command line.

pub(crate) const HELP: &str = "\
Do the selection procedures keep their guarantees? Minutes on two cores.

verify [--only WORDS] [--replications N] [--seed N] [--json]
verify requirement [--help]    the procedure for requirements

  --only WORDS      only lines whose name contains these words, such as \"race slippage\"
  --replications N  macro-replications of every line, for a quick check [depends on the line]
  --seed N          seed of all random numbers [7]
  --json            print an array of objects instead of a table
  --help            print this help

Exit code: 0 if every line passed, 1 if one failed, 2 if the command line is wrong.
A correct answer is a selection less than delta worse than the best, or bounds that all held at
every moment. A line passes if the 99% lower bound (Clopper-Pearson) of its share of correct answers
is at least 0.95, or, for the reference procedures, if its average runs are within 2% of the
published ones. A line that is unfit or broken on purpose passes if the 99% upper bound is below
0.95, which shows that the gate can fail.";

/// The options given.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Arguments {
    pub(crate) help: bool,
    pub(crate) json: bool,
    pub(crate) only: String,
    pub(crate) replications: Option<u32>,
    pub(crate) seed: u64,
}

impl Arguments {
    /// # Errors
    /// What is wrong with the first invalid word.
    pub(crate) fn parse(mut words: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut arguments = Self {
            help: false,
            json: false,
            only: String::new(),
            replications: None,
            seed: 7,
        };
        while let Some(word) = words.next() {
            match word.as_str() {
                "--help" | "-h" => arguments.help = true,
                "--json" => arguments.json = true,
                "--only" => arguments.only = words.next().ok_or("--only: expected words")?,
                "--replications" => arguments.replications = Some(number(&word, words.next())?),
                "--seed" => arguments.seed = number(&word, words.next())?,
                _ => return Err(format!("{word}: no such option; see --help")),
            }
        }
        if arguments.replications == Some(0) {
            return Err("--replications 0: must be at least 1".to_owned());
        }
        Ok(arguments)
    }
}

fn number<T: std::str::FromStr>(option: &str, word: Option<String>) -> Result<T, String> {
    let word = word.ok_or_else(|| format!("{option}: expected a number"))?;
    let wrong = |_| format!("{option} {word}: must be a whole number of 0 or more");
    word.parse().map_err(wrong)
}
