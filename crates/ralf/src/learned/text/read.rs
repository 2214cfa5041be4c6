//! Models, read.

use super::super::calibration::Calibration;
use super::super::familiar::Seen;
use super::super::forest::Forest;
use super::super::model::{CauseForest, Corrected, Input, Model, Origin, World};
use super::super::tree::{Leaf, Node, Split, Tree};
use super::{HEAD, checksum};
use std::collections::HashSet;
use std::iter::Peekable;
use std::str::{Lines, SplitWhitespace};
use thiserror::Error;

/// A text that is no model.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("line {line}: expected {expected}, found {found}")]
pub struct ReadError {
    /// From 1.
    pub line: usize,
    /// What should stand there.
    pub expected: String,
    /// What does.
    pub found: String,
}

/// Reads a whole text.
pub(super) fn model(text: &str) -> Result<Model, ReadError> {
    let mut reader = Reader { lines: text.lines().enumerate().peekable() };
    let head = reader.next(HEAD)?;
    if head.text != HEAD {
        return Err(head.refuse(format!("`{HEAD}`")));
    }
    let origin = reader.origin()?;
    let expects = reader.next_if("expects")?.map(|line| line.share()).transpose()?;
    let (mut inputs, mut names) = (Vec::new(), HashSet::new());
    while let Some(line) = reader.next_if("input")? {
        let input = line.input()?;
        if !names.insert(input.name.clone()) {
            return Err(line.refuse("each input once"));
        }
        inputs.push(input);
    }
    let calibration = reader.calibration()?;
    let plausible = reader.forest("plausible")?;
    let mut causes = Vec::new();
    while let Some(cause) = reader.cause()? {
        causes.push(cause);
    }
    let net = reader.net()?;
    let corrected = reader.corrected()?;
    reader.end(text)?;
    match reader.lines.next() {
        None => Ok(Model { origin, expects, inputs, plausible, net, calibration, causes, corrected }),
        Some((at, text)) => Err(Line { at, key: "", text, rest: text }.refuse("no further line")),
    }
}

/// A line: its key, and what follows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line<'a> {
    at: usize,
    key: &'a str,
    text: &'a str,
    pub(super) rest: &'a str,
}

pub(super) struct Reader<'a> {
    lines: Peekable<std::iter::Enumerate<Lines<'a>>>,
}

impl<'a> Reader<'a> {
    fn next(&mut self, expected: &str) -> Result<Line<'a>, ReadError> {
        let Some((at, text)) = self.lines.next() else {
            let found = "the end of the text".to_owned();
            return Err(ReadError { line: 0, expected: format!("`{expected}`"), found });
        };
        let (key, rest) = text.split_once(' ').unwrap_or((text, ""));
        Ok(Line { at, key, text, rest })
    }

    /// The next line, if it has this key.
    pub(super) fn next_if(&mut self, key: &str) -> Result<Option<Line<'a>>, ReadError> {
        let has = self.lines.peek().is_some_and(|(_, text)| text.split(' ').next() == Some(key));
        if has { self.next(key).map(Some) } else { Ok(None) }
    }

    pub(super) fn with_key(&mut self, key: &str) -> Result<Line<'a>, ReadError> {
        let line = self.next(key)?;
        if line.key == key { Ok(line) } else { Err(line.refuse(format!("`{key}`"))) }
    }

    /// The last line of this text, which tells how many are before it, and their checksum. Models of earlier programs
    /// tell neither or the first alone, and so may what people changed by hand.
    fn end(&mut self, text: &str) -> Result<(), ReadError> {
        let end = self.next("end")?;
        // It is whole only with its own end.
        if end.key != "end" || !text.ends_with('\n') {
            return Err(end.refuse("another forest, a net, what was corrected, or `end` as the last line"));
        }
        let (lines, sum) = match end.rest.split_once(' ') {
            Some((lines, sum)) => (lines, Some(sum)),
            None => (end.rest, None),
        };
        if end.text != "end" && lines.parse() != Ok(end.at) {
            return Err(end.refuse(format!("`end {}`, for so many lines are before it", end.at)));
        }
        let expected = checksum(text.lines().take(end.at));
        if sum.is_some_and(|sum| sum != expected) {
            let why = "the checksum of the lines before it; without it, whatever they say is taken";
            return Err(end.refuse(format!("`end {} {expected}`, {why}", end.at)));
        }
        Ok(())
    }

    fn origin(&mut self) -> Result<Origin, ReadError> {
        let program = self.with_key("program")?.rest.to_owned();
        let command = self.with_key("command")?.rest.to_owned();
        let line = self.with_key("seed")?;
        let seed = line.rest.parse().map_err(|_| line.refuse("seed and a whole number"))?;
        Ok(Origin { program, command, seed, worlds: self.worlds("world")? })
    }

    /// All next lines that have this key.
    fn worlds(&mut self, key: &str) -> Result<Vec<World>, ReadError> {
        let mut worlds = Vec::new();
        while let Some(line) = self.next_if(key)? {
            worlds.push(line.world().ok_or_else(|| {
                line.refuse(format!("{key}, a count, another of no more, a name, a colon and scores"))
            })?);
        }
        Ok(worlds)
    }

    fn calibration(&mut self) -> Result<Calibration, ReadError> {
        let mut last = self.with_key("calibrated")?;
        let mut points = vec![last.point()?];
        while let Some(line) = self.next_if("calibrated")? {
            points.push(line.point()?);
            last = line;
        }
        Calibration::new(points).map_err(|error| last.refuse(error))
    }

    fn forest(&mut self, name: &str) -> Result<Forest, ReadError> {
        let line = self.with_key("forest")?;
        match line.rest.split_once(' ') {
            Some((base, found)) if found == name => self.trees(line, base),
            _ => Err(line.refuse(format!("forest, a number and `{name}`"))),
        }
    }

    /// The next cause's forest, if there is one.
    fn cause(&mut self) -> Result<Option<CauseForest>, ReadError> {
        let Some(line) = self.next_if("forest")? else { return Ok(None) };
        let Some((base, name)) = line.rest.split_once(" cause ") else {
            return Err(line.refuse("forest, a number and the name of a cause"));
        };
        Ok(Some(CauseForest { name: name.to_owned(), forest: self.trees(line, base)? }))
    }

    /// What was corrected, if anything was.
    fn corrected(&mut self) -> Result<Option<Corrected>, ReadError> {
        let worlds = self.worlds("corrected")?;
        if worlds.is_empty() {
            return Ok(None);
        }
        Ok(Some(Corrected { forest: self.forest("corrected")?, worlds }))
    }

    fn trees(&mut self, line: Line, base: &str) -> Result<Forest, ReadError> {
        let base = base.parse().ok().filter(|base: &f64| base.is_finite());
        let base = base.ok_or_else(|| line.refuse("finite log odds"))?;
        let mut trees = Vec::new();
        while let Some(line) = self.next_if("tree")? {
            let nodes = nodes(line.rest).ok_or_else(|| line.refuse("nodes of a tree"))?;
            trees.push(Tree::new(nodes).map_err(|error| line.refuse(error))?);
        }
        Ok(Forest { base, trees })
    }
}

/// The nodes of a line; `None` where one isn't whole.
fn nodes(text: &str) -> Option<Vec<Node>> {
    let mut words = text.split_whitespace();
    let mut nodes = Vec::new();
    while let Some(first) = words.next() {
        nodes.push(if first == "=" {
            Node::Leaf(Leaf { value: number(&mut words)?, cover: number(&mut words)? })
        } else {
            let threshold = number(&mut words)?;
            let absent_is_yes = match words.next()? {
                "y" => true,
                "n" => false,
                _ => return None,
            };
            Node::Split(Split { feature: first.parse().ok()?, threshold, absent_is_yes, right: 0 })
        });
    }
    Some(nodes)
}

fn number(words: &mut SplitWhitespace) -> Option<f32> {
    words.next()?.parse().ok()
}

impl Line<'_> {
    pub(super) fn refuse(&self, expected: impl ToString) -> ReadError {
        // A tree's line may be long.
        let mut found: String = self.text.chars().take(60).collect();
        if found.len() < self.text.len() {
            found += " ...";
        }
        let expected = expected.to_string().trim_start_matches("expected ").to_owned();
        ReadError { line: self.at + 1, expected, found: format!("`{found}`") }
    }

    fn world(&self) -> Option<World> {
        let (head, told) = self.rest.split_once(':')?;
        let mut words = head.splitn(3, ' ');
        let (detections, plausible) = (words.next()?.parse().ok()?, words.next()?.parse().ok()?);
        if plausible > detections {
            return None;
        }
        let name = words.next()?.to_owned();
        let words: Vec<&str> = told.split_whitespace().collect();
        if words.len() % 2 == 1 {
            return None;
        }
        let scores = words.chunks(2).map(|pair| (pair[0].to_owned(), pair[1].to_owned())).collect();
        Some(World { name, detections, plausible, scores })
    }

    fn share(&self) -> Result<f64, ReadError> {
        let share = self.rest.parse().ok().filter(|share: &f64| *share > 0.0 && *share < 1.0);
        share.ok_or_else(|| self.refuse("expects and a share between 0 and 1"))
    }

    fn input(&self) -> Result<Input, ReadError> {
        let refuse =
            || self.refuse("input, a name, a rising range, a share in [0, 1] and a worth of 0 or more");
        let (name, numbers) = self.rest.split_once(' ').ok_or_else(refuse)?;
        let numbers: Option<Vec<f32>> = numbers.split(' ').map(|word| word.parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[low, high, absent, gain])
                if [low, high, absent, gain].iter().all(|number| number.is_finite())
                    && low <= high
                    && (0.0..=1.0).contains(&absent)
                    && gain >= 0.0 =>
            {
                Ok(Input { name: name.to_owned(), seen: Seen { low, high, absent, gain } })
            }
            _ => Err(refuse()),
        }
    }

    fn point(&self) -> Result<(f64, f64), ReadError> {
        let refuse = || self.refuse("calibrated and two numbers");
        let (log_odds, probability) = self.rest.split_once(' ').ok_or_else(refuse)?;
        Ok((log_odds.parse().map_err(|_| refuse())?, probability.parse().map_err(|_| refuse())?))
    }
}
