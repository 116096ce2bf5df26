//! Expressions among the properties of a node.

use crate::{Diagnostic, ParameterKind, Params, Value};
use etalon_math::Expression;
use etalon_math::expression::ExpressionError;

impl Params<'_> {
    /// The expression of some variables in a property; `None` if there is none, or after a mistake.
    pub fn expression(&self, name: &str, variables: &[&str]) -> Option<Expression> {
        let read = Expression::parse(self.string(name)?, variables);
        read.map_err(|error| self.report(name, variables, &error))
            .ok()
    }

    /// A number, or an expression of some variables in a string; the default if it is not given.
    pub fn number_or_expression(
        &self,
        name: &str,
        default: f64,
        variables: &[&str],
    ) -> Option<Expression> {
        let property = self.node.property(name);
        if property.is_some_and(|property| matches!(property.value, Value::String(_))) {
            return self.expression(name, variables);
        }
        let number = self.float(name).unwrap_or(default);
        self.note_default(
            name,
            ParameterKind::Words("a number or an expression"),
            default,
        );
        Expression::parse(&format!("({number})"), &[]).ok()
    }

    /// Records what is wrong with an expression of some variables.
    fn report(&self, name: &str, variables: &[&str], error: &ExpressionError) {
        let property = self.node.property(name);
        let span = property.map_or(self.node.plugin.span, |p| p.span);
        let (message, character) = (&error.message, error.character);
        let message = format!("{message} at character {character} of `{name}`");
        let diagnostic = Diagnostic::error(span, message);
        let mut known: Vec<&str> = Expression::names().collect();
        known.extend(variables);
        self.diagnostics.push(match &error.unknown {
            Some(word) => diagnostic.suggest(word, known),
            None => diagnostic,
        });
    }
}
