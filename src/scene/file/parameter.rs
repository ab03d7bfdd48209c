//! `[parameters]`: values that the rest of the file refers to as `"$name"`, and that a case may override.
//!
//! They are put in before the file is given its meaning, so any value of any kind can be one, and a
//! wrong one is underlined where it is used.

use super::Overrides;
use crate::scene::SceneError;
use crate::text::{Diagnostic, Source, did_you_mean, listed};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

/// The parameters of a scene with the values they have this time.
pub(super) struct Parameters(BTreeMap<String, Parameter>);

struct Parameter {
    /// The value, as TOML.
    text: String,
    span: Range<usize>,
    is_used: Cell<bool>,
    is_overridden: bool,
}

impl Parameters {
    /// What a file declares, with `overrides` applied.
    pub(crate) fn read(
        scene: &str,
        source: &Source,
        overrides: &Overrides,
    ) -> Result<Self, SceneError> {
        let mut parameters = Self(declared(source)?);
        for (name, value) in overrides {
            match parameters.0.get_mut(name) {
                Some(parameter) => {
                    parameter.text = value.to_string();
                    parameter.is_overridden = true;
                }
                None => return Err(parameters.unknown(scene, name)),
            }
        }
        Ok(parameters)
    }

    /// Puts values in for every `"$name"`. A parameter that nothing refers to is a mistake.
    pub(crate) fn substitute<'a>(
        &'a self,
        source: &Source,
        document: &mut DeTable<'a>,
    ) -> Result<(), Diagnostic> {
        document.remove(KEY);
        for (_, value) in document.iter_mut() {
            self.substitute_in(source, value)?;
        }
        match self.0.iter().find(|(_, parameter)| !parameter.is_used.get()) {
            None => Ok(()),
            Some((name, parameter)) => {
                let problem = format!("parameter `{name}` is unused");
                let hint = format!("write \"${name}\" where its value belongs");
                Err(source.diagnostic(parameter.span.clone(), problem).with_hint(hint))
            }
        }
    }

    /// Adds what a parameter stands for to a complaint about a place where one is used. A value from elsewhere is at
    /// fault itself.
    pub(crate) fn explain(&self, diagnostic: Diagnostic) -> SceneError {
        let place = diagnostic.source.text.get(diagnostic.span.clone()).unwrap_or_default();
        let is_there = |name: &str| place.contains(&format!("\"${name}\""));
        let used = self.0.iter().find(|(name, _)| is_there(name));
        let Some((name, parameter)) = used else { return diagnostic.into() };
        let diagnostic = diagnostic.with_hint(format!("here `${name}` is {}", parameter.text));
        match parameter.is_overridden {
            false => diagnostic.into(),
            true => SceneError::WrongParameter {
                parameter: name.clone(),
                diagnostic: Box::new(diagnostic),
            },
        }
    }

    fn substitute_in<'a>(
        &'a self,
        source: &Source,
        value: &mut Spanned<DeValue<'a>>,
    ) -> Result<(), Diagnostic> {
        let span = value.span();
        let name = match value.get_mut() {
            DeValue::Array(items) => {
                return items.iter_mut().try_for_each(|item| self.substitute_in(source, item));
            }
            DeValue::Table(table) => {
                return table
                    .iter_mut()
                    .try_for_each(|(_, entry)| self.substitute_in(source, entry));
            }
            DeValue::String(text) => text.strip_prefix('$').map(str::to_owned),
            _ => None,
        };
        if let Some(name) = name {
            let parsed = DeValue::parse(self.text_of(&name, source, &span)?);
            let parsed = parsed.map_err(|error| unreadable(source, &span, &error))?;
            *value = at(&span, parsed.into_inner());
        }
        Ok(())
    }

    fn text_of(
        &self,
        name: &str,
        source: &Source,
        span: &Range<usize>,
    ) -> Result<&str, Diagnostic> {
        let parameter = self.0.get(name).ok_or_else(|| {
            let problem = format!("there is no parameter `{name}`, only {}", self.names());
            let hint = did_you_mean(name, self.0.keys().map(String::as_str));
            source.diagnostic(span.clone(), problem).with_hint_if_any(hint)
        })?;
        parameter.is_used.set(true);
        Ok(&parameter.text)
    }

    fn names(&self) -> String {
        listed(self.0.keys().map(String::as_str))
    }

    fn unknown(&self, scene: &str, name: &str) -> SceneError {
        let problem = match self.0.is_empty() {
            true => format!("scene `{scene}` has no parameters, and `{name}` is set"),
            false => format!("scene `{scene}` has no parameter `{name}`, only {}", self.names()),
        };
        SceneError::NoSuchParameter {
            parameter: name.to_owned(),
            problem,
            hint: did_you_mean(name, self.0.keys().map(String::as_str)),
        }
    }
}

const KEY: &str = "parameters";

fn declared(source: &Source) -> Result<BTreeMap<String, Parameter>, Diagnostic> {
    let document = DeTable::parse(&source.text);
    let mut document = document.map_err(|error| source.toml_diagnostic(error))?;
    let Some(table) = document.get_mut().remove(KEY) else { return Ok(BTreeMap::new()) };
    let DeValue::Table(table) = table.get_ref() else {
        let problem = "`parameters` is a table of names and values";
        return Err(source.diagnostic(table.span(), problem));
    };
    let declare = |(name, value): (&Spanned<_>, &Spanned<DeValue<'_>>)| {
        let text = source.text[value.span()].to_owned();
        let name_text: &str = std::borrow::Borrow::borrow(name);
        (
            name_text.to_owned(),
            Parameter { text, span: name.span(), is_used: Cell::new(false), is_overridden: false },
        )
    };
    Ok(table.iter().map(declare).collect())
}

fn unreadable(source: &Source, span: &Range<usize>, error: &Error) -> Diagnostic {
    source.diagnostic(span.clone(), format!("the parameter's value: {}", error.message()))
}

/// A value as though it had been written at `span`.
fn at<'a>(span: &Range<usize>, value: DeValue<'a>) -> Spanned<DeValue<'a>> {
    let moved = match value {
        DeValue::Array(items) => {
            DeValue::Array(items.into_iter().map(|item| at(span, item.into_inner())).collect())
        }
        DeValue::Table(table) => {
            let entry = |(key, value): (Spanned<_>, Spanned<DeValue<'a>>)| {
                (Spanned::new(span.clone(), key.into_inner()), at(span, value.into_inner()))
            };
            DeValue::Table(table.into_iter().map(entry).collect())
        }
        plain => plain,
    };
    Spanned::new(span.clone(), moved)
}
