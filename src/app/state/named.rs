//! A macro for enums whose variants have names.

/// An enum with the name of each variant, `ALL` of them in this order, and `name`.
macro_rules! named {
    ($(#[$meta:meta])* pub enum $choice:ident { $($(#[$of_variant:meta])* $variant:ident = $name:literal,)* }) => {
        $(#[$meta])*
        pub enum $choice {
            $($(#[$of_variant])* $variant,)*
        }

        impl $choice {
            /// All variants, in the order of menus.
            pub const ALL: [$choice; [$($name),*].len()] = [$($choice::$variant),*];

            /// Name of the variant.
            pub fn name(self) -> &'static str {
                match self {
                    $($choice::$variant => $name,)*
                }
            }
        }
    };
}
