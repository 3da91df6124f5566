//! A place in the JSON tree with its pointer, and typed reading that says where and what was expected.
use serde_json::Value;

/// Something wrong at one place of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Fault {
    /// JSON pointer (RFC 6901).
    pub(super) pointer: String,
    /// What is wrong and what was expected.
    pub(super) message: String,
    /// What to do.
    pub(super) hint: Option<String>,
}

/// A value or what is wrong with the file.
pub(super) type Checked<T> = Result<T, Fault>;

/// A JSON value and where it is.
#[derive(Clone, Debug)]
pub(super) struct Element<'a> {
    value: &'a Value,
    pointer: String,
}

/// What messages call a value.
pub(super) fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "a truth value",
        Value::Number(_) => "a number",
        Value::String(_) => "a string",
        Value::Array(_) => "an array",
        Value::Object(_) => "an object",
    }
}

impl<'a> Element<'a> {
    /// The whole document.
    pub(super) fn root(value: &'a Value) -> Self {
        Self { value, pointer: String::new() }
    }
    /// JSON pointer.
    pub(super) fn pointer(&self) -> &str {
        &self.pointer
    }
    /// A complaint about this place.
    pub(super) fn fault(&self, message: impl Into<String>) -> Fault {
        Fault { pointer: self.pointer.clone(), message: message.into(), hint: None }
    }
    /// A complaint about the member `key`, whether or not it is written.
    pub(super) fn fault_at(&self, key: &str, message: impl Into<String>) -> Fault {
        Fault { pointer: format!("{}/{key}", self.pointer), message: message.into(), hint: None }
    }
    fn expected(&self, what: &str) -> Fault {
        self.fault(format!("expected {what}, found {}", kind(self.value)))
    }
    fn child(&self, key: &str, value: &'a Value) -> Self {
        let key = key.replace('~', "~0").replace('/', "~1");
        Self { value, pointer: format!("{}/{key}", self.pointer) }
    }
    /// The member `key` of an object, if there is one.
    pub(super) fn get(&self, key: &str) -> Checked<Option<Self>> {
        let object = self.value.as_object().ok_or_else(|| self.expected("an object"))?;
        Ok(object.get(key).map(|v| self.child(key, v)))
    }
    /// The member `key` of an object.
    pub(super) fn required(&self, key: &str) -> Checked<Self> {
        self.get(key)?.ok_or_else(|| self.fault(format!("\"{key}\" is missing")))
    }
    /// The extension object `name`.
    pub(super) fn extension(&self, name: &str) -> Checked<Option<Self>> {
        match self.get("extensions")? {
            Some(extensions) => extensions.get(name),
            None => Ok(None),
        }
    }
    /// The elements of an array.
    pub(super) fn items(&self) -> Checked<impl ExactSizeIterator<Item = Self> + use<'a>> {
        let array = self.value.as_array().ok_or_else(|| self.expected("an array"))?;
        let pointer = self.pointer.clone();
        Ok(array.iter().enumerate().map(move |(i, value)| Self { value, pointer: format!("{pointer}/{i}") }))
    }
    /// The elements of the array `key`; none if it is missing.
    pub(super) fn list(&self, key: &str) -> Checked<Vec<Self>> {
        match self.get(key)? {
            Some(array) => Ok(array.items()?.collect()),
            None => Ok(Vec::new()),
        }
    }
    /// Element `index` of the array `key`; `None` if there are fewer.
    pub(super) fn list_item(&self, key: &str, index: usize) -> Checked<Option<Self>> {
        let Some(list) = self.get(key)? else {
            return Ok(None);
        };
        let array = list.value.as_array().ok_or_else(|| list.expected("an array"))?;
        Ok(array.get(index).map(|value| list.child(&index.to_string(), value)))
    }
    /// What the name leads to: a member of an object, or an element of an array by its index.
    pub(super) fn step(&self, name: &str) -> Option<Self> {
        let found = match self.value {
            Value::Array(array) => array.get(name.parse::<usize>().ok()?),
            value => value.get(name),
        };
        found.map(|value| self.child(name, value))
    }
    /// The names of an object's members.
    pub(super) fn keys(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        self.value.as_object().into_iter().flat_map(|o| o.keys().map(String::as_str))
    }
    /// A number that fits an `f32`.
    pub(super) fn number(&self) -> Checked<f64> {
        let number = self.value.as_f64().ok_or_else(|| self.expected("a number"))?;
        if number.abs() > f64::from(f32::MAX) {
            return Err(self.fault(format!("{number:e} is too large")));
        }
        Ok(number)
    }
    /// A whole number from 0.
    pub(super) fn index(&self) -> Checked<usize> {
        let wrong = || self.fault(format!("expected a whole number from 0, found {}", self.value));
        let whole = match (self.value.as_u64(), self.value.as_f64()) {
            (Some(n), _) => n,
            // Some exporters write 3.0.
            (None, Some(f)) if (0.0..9e15).contains(&f) && f.fract() == 0.0 => f as u64,
            (None, Some(_)) => return Err(wrong()),
            (None, None) => return Err(self.expected("a whole number")),
        };
        usize::try_from(whole).map_err(|_| wrong())
    }
    /// A truth value.
    pub(super) fn truth(&self) -> Checked<bool> {
        self.value.as_bool().ok_or_else(|| self.expected("true or false"))
    }
    /// A string.
    pub(super) fn text(&self) -> Checked<&'a str> {
        self.value.as_str().ok_or_else(|| self.expected("a string"))
    }
    /// Exactly `N` numbers.
    pub(super) fn numbers<const N: usize>(&self) -> Checked<[f64; N]> {
        let items = self.items()?;
        let found = items.len();
        let numbers = items.map(|i| i.number()).collect::<Checked<Vec<f64>>>()?;
        numbers
            .try_into()
            .map_err(|_| self.fault(format!("expected {}, found {found}", durer_scene::counted(N, "number"))))
    }

    /// The number `key`, or `default` if it is missing.
    pub(super) fn number_or(&self, key: &str, default: f64) -> Checked<f64> {
        self.get(key)?.map_or(Ok(default), |e| e.number())
    }
    /// The whole number `key`, or `default` if it is missing.
    pub(super) fn index_or(&self, key: &str, default: usize) -> Checked<usize> {
        self.get(key)?.map_or(Ok(default), |e| e.index())
    }
    /// The numbers `key`, or `default` if they are missing.
    pub(super) fn numbers_or<const N: usize>(&self, key: &str, default: [f64; N]) -> Checked<[f64; N]> {
        self.get(key)?.map_or(Ok(default), |e| e.numbers())
    }
    /// The string `key`, or `default` if it is missing.
    pub(super) fn text_or(&self, key: &str, default: &'a str) -> Checked<&'a str> {
        self.get(key)?.map_or(Ok(default), |e| e.text())
    }
    /// The truth value `key`; false if it is missing.
    pub(super) fn flag(&self, key: &str) -> Checked<bool> {
        self.get(key)?.map_or(Ok(false), |flag| flag.truth())
    }
    /// The member `name`, or nothing: a missing or ill-typed name is no reason to refuse a scene.
    pub(super) fn name(&self) -> &'a str {
        self.value.get("name").and_then(Value::as_str).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_carry_the_pointer_and_what_was_expected() {
        let value = serde_json::json!({"a/b": [1, "x", 3.0, -1, 1e60]});
        let list = Element::root(&value).list("a/b").unwrap_or_default();
        let fault = list.get(1).map(Element::number);
        let text = "expected a number, found a string".to_owned();
        assert_eq!(fault, Some(Err(Fault { pointer: "/a~1b/1".to_owned(), message: text, hint: None })));
        assert_eq!(list.get(2).map(Element::index), Some(Ok(3)));
        assert!(matches!(list.get(3).map(Element::index), Some(Err(_))));
        assert!(matches!(list.get(4).map(Element::number), Some(Err(_))));
        assert!(Element::root(&value).required("c").is_err_and(|f| f.message.contains("\"c\" is missing")));
    }
}
