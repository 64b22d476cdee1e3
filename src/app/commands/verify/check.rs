//! A row of the table: one kind of thing that was checked.

use std::fmt::Display;
use std::path::Path;

/// So many things that are wrong with one kind are listed.
const LISTED: usize = 10;

/// What was checked, how much of it, and what came of it.
#[derive(Debug, Default)]
pub struct Check {
    subject: &'static str,
    checked: String,
    result: Option<String>,
    damage: Vec<String>,
    notes: Vec<String>,
}

impl Check {
    /// A check that has found nothing yet.
    pub fn of(subject: &'static str) -> Self {
        Self { subject, ..Self::default() }
    }

    /// Says how much was checked.
    pub fn checked(self, checked: impl Into<String>) -> Self {
        Self { checked: checked.into(), ..self }
    }

    /// Says what came of it, if nothing is wrong and nothing is worth a word: otherwise it is “ok”.
    pub fn result(&mut self, result: impl Into<String>) {
        self.result = Some(result.into());
    }

    /// Adds something that is wrong.
    pub fn damaged(&mut self, sentence: impl Display) {
        self.damage.push(sentence.to_string());
    }

    /// Adds what is wrong with a file, if anything.
    pub fn judge(&mut self, path: &Path, judged: Result<(), String>) {
        if let Err(reason) = judged {
            self.damaged(format_args!("{} is damaged: {reason}", path.display()));
        }
    }

    /// Adds something that is worth a word, and not wrong.
    pub fn note(&mut self, sentence: impl Into<String>) {
        self.notes.push(sentence.into());
    }

    /// Whether nothing is wrong.
    pub fn is_fine(&self) -> bool {
        self.damage.is_empty()
    }

    /// What is wrong, a sentence each.
    pub fn damage(&self) -> &[String] {
        &self.damage
    }

    /// What is worth a word, a sentence each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Its rows of the table: one, or one for each sentence.
    pub fn rows(&self) -> Vec<[String; 3]> {
        let more = self.damage.len().saturating_sub(LISTED);
        let mut sentences: Vec<String> = self.damage.iter().take(LISTED).cloned().collect();
        sentences.extend((more > 0).then(|| format!("and {more} more")));
        sentences.extend(self.notes.iter().take(LISTED).cloned());
        if sentences.is_empty() {
            sentences.push(self.result.clone().unwrap_or_else(|| "ok".to_owned()));
        }
        let first = [self.subject.to_owned(), self.checked.clone()];
        let heads = std::iter::once(first).chain(std::iter::repeat_with(Default::default));
        heads.zip(sentences).map(|([subject, checked], said)| [subject, checked, said]).collect()
    }
}

/// A number of things, in words.
pub fn counted(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}
