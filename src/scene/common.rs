//! Parts common to all kinds of objects: fields of files, and a match over the kinds.

/// An object: its own fields, then the fields of every object.
macro_rules! moving {
    ($(#[$about:meta])* pub struct $name:ident { $($fields:tt)* }) => {
        $(#[$about])*
        #[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct $name {
            /// Name of the object, empty for none; at most [`MAX_NAME_CHARACTERS`](super::MAX_NAME_CHARACTERS).
            #[serde(default, skip_serializing_if = "String::is_empty")]
            pub name: String,
            $($fields)*
            #[serde(default, skip_serializing_if = "is_default")]
            pub velocity_x_metres_per_second: f64,
            #[serde(default, skip_serializing_if = "is_default")]
            pub velocity_y_metres_per_second: f64,
        }
    };
}
pub(super) use moving;

/// One expression for an object of any kind.
macro_rules! of_each {
    ($object:expr, $one:ident => $what:expr) => {
        match $object {
            Object::Point($one) => $what,
            Object::Line($one) => $what,
            Object::Gaussian($one) => $what,
            Object::Wall($one) => $what,
            Object::Box($one) => $what,
            Object::Post($one) => $what,
            Object::Polygon($one) => $what,
        }
    };
}
pub(super) use of_each;

/// Whether a value is that of a file that leaves it out.
pub(crate) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
