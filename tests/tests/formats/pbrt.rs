//! The language of pbrt-v4: every directive, and every kind with the parameters that pbrt documents, as `pbrt.txt` lists
//! them.
//!
//! There, `#` begins a family, `>` says how a kind stands in a scene (`@` for it and its parameters, `/` for line ends);
//! a kind comes with what it cannot do without, and its other parameters stand below it. Of directives, what is left of
//! `|` stands before `WorldBegin`.
use super::trial::{Bench, Outcome, remark};

const LIST: &str = include_str!("pbrt.txt");

/// A kind of pbrt-v4.
struct Kind {
    name: &'static str,
    /// Parameters without which it means nothing.
    needs: &'static str,
    /// The others.
    params: Vec<&'static str>,
}

/// A family of kinds.
struct Family {
    title: &'static str,
    /// How a kind stands in a scene.
    scene: String,
    kinds: Vec<Kind>,
}

impl Family {
    fn read(text: &'static str) -> Self {
        let mut lines = text.lines();
        let title = lines.next().expect("a title");
        let scene =
            lines.next().and_then(|line| line.strip_prefix("> ")).expect("a scene").replace(" / ", "\n");
        let mut kinds: Vec<Kind> = Vec::new();
        for line in lines.filter(|line| !line.is_empty()) {
            match (line.strip_prefix("    "), kinds.last_mut()) {
                (Some(param), Some(kind)) => kind.params.push(param),
                _ => {
                    let (name, needs) = line.split_once(' ').unwrap_or((line, ""));
                    kinds.push(Kind { name, needs, params: Vec::new() });
                }
            }
        }
        Self { title, scene, kinds }
    }

    fn write(&self, bench: &Bench, out: &mut String) {
        let word = self.word();
        out.push_str(&format!("\n### {}\n\n| kind | parameters that are read |\n|---|---|\n", self.title));
        let mut remarks = String::new();
        for kind in &self.kinds {
            let plain = self.outcome(bench, kind, "");
            let head = format!("{word}\"{}\"", kind.name);
            if let Some(line) = remark(&head, &plain) {
                remarks.push_str(&line);
            }
            if plain != Outcome::Read {
                continue;
            }
            let mut read = named(kind.needs);
            for param in &kind.params {
                match self.outcome(bench, kind, param) {
                    Outcome::Read => {
                        let new = named(param).into_iter().filter(|name| !read.contains(name));
                        read.extend(new.collect::<Vec<_>>());
                    }
                    outcome => {
                        remarks.push_str(&remark(&format!("{head} {param}"), &outcome).unwrap_or_default())
                    }
                }
            }
            out.push_str(&format!("| `{}` | {} |\n", kind.name, read.join(", ")));
        }
        if !remarks.is_empty() {
            out.push_str(&format!("\n{remarks}"));
        }
    }

    /// The directive.
    fn word(&self) -> &str {
        let line = self.scene.lines().find(|line| line.contains('@')).expect("a place");
        line.split('@').next().expect("a directive")
    }

    fn outcome(&self, bench: &Bench, kind: &Kind, param: &str) -> Outcome {
        let Kind { name, needs, .. } = kind;
        let own = format!("\"{name}\" {needs} {param}");
        // A texture for the parameters that refer to one.
        let texture = if param.contains("texture ") { "Texture \"t\" \"float\" \"constant\"\n" } else { "" };
        let scene = self.scene.replace("WorldBegin\n", &format!("WorldBegin\n{texture}"));
        bench.try_file("x.pbrt", scene.replace('@', &own) + "\n")
    }
}

pub(crate) fn write(out: &mut String) {
    let bench = Bench::new();
    out.push_str("\n## pbrt-v4\n");
    let (families, directives) = LIST.split_once("# Directives\n").expect("directives");
    for family in families.split("# ").filter(|text| !text.is_empty()) {
        Family::read(family).write(&bench, out);
    }
    out.push_str("\n### Directives\n\n");
    let tried: Vec<(String, Outcome)> = directives.lines().map(|line| directive(&bench, line)).collect();
    let read = tried.iter().filter(|(_, o)| *o == Outcome::Read).map(|(f, _)| format!("`{f}`"));
    out.push_str(&format!("Read: {}.\n\n", read.collect::<Vec<_>>().join(", ")));
    tried.iter().filter_map(|(f, o)| remark(f, o)).for_each(|line| out.push_str(&line));
}

fn directive(bench: &Bench, line: &str) -> (String, Outcome) {
    let (before, after) = line.split_once('|').expect("before | after");
    let outcome = bench.try_file("x.pbrt", format!("{before}\nWorldBegin\n{after}\nShape \"sphere\"\n"));
    (if after.trim().is_empty() { before } else { after }.trim().to_owned(), outcome)
}

/// Names of the parameters, and the word where it is a choice.
fn named(params: &str) -> Vec<String> {
    let words: Vec<&str> = params.split('"').collect();
    let mut names = Vec::new();
    for pair in words.chunks(2).filter(|pair| pair.len() == 2) {
        let [before, inside] = [pair[0], pair[1]];
        match inside.split_once(' ') {
            Some((ty, name)) if is_type(ty) => names.push(format!("`{name}`")),
            _ if !before.contains('[') && !inside.contains('.') => {
                let last = names.pop().unwrap_or_default();
                names.push(format!("{last} `{inside}`"));
            }
            _ => {}
        }
    }
    names
}

fn is_type(word: &str) -> bool {
    let types = "float integer bool string point2 point3 vector3 normal rgb spectrum blackbody texture";
    types.split(' ').any(|t| t == word)
}
