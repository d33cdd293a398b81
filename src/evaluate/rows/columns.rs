//! The macro that makes the struct of a row and the list of its columns out of one table.

/// Makes `Row` and `Column`. A line of the table is a field of `Row`, its type, and the name of its column in code: `name: Type = Name`.
macro_rules! columns {
    (
        figures { $($(#[$of_figure:meta])* $figure:ident: $figure_type:ty = $Figure:ident,)+ }
        origin { $($(#[$of_origin:meta])* $origin:ident: $origin_type:ty = $Origin:ident,)+ }
    ) => {
        /// The result of one method on one scene, and its origin. The fields are the columns of the file.
        #[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
        #[serde(default)]
        pub struct Row {
            $($(#[$of_figure])* pub $figure: $figure_type,)+
            $($(#[$of_origin])* pub $origin: $origin_type,)+
        }

        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[expect(missing_docs, reason = "the fields of `Row` say what they are")]
        pub enum Column {
            $($Figure,)+
            $($Origin,)+
        }

        impl Column {
            /// The columns of scenes, methods and figures, in the file's order.
            pub const FIGURES: &[Column] = &[$(Column::$Figure),+];
            /// The columns of a row's origin; they stand behind the figures.
            pub const ORIGIN: &[Column] = &[$(Column::$Origin),+];

            /// Name in the file's first line and in filters.
            pub fn name(self) -> &'static str {
                match self {
                    $(Column::$Figure => stringify!($figure),)+
                    $(Column::$Origin => stringify!($origin),)+
                }
            }

            /// The type of its cells.
            pub fn kind(self) -> CellKind {
                match self {
                    $(Column::$Figure => <$figure_type as CellValue>::KIND,)+
                    $(Column::$Origin => <$origin_type as CellValue>::KIND,)+
                }
            }

            /// Whether two rows have the same cell in the column.
            pub fn is_same(self, a: &Row, b: &Row) -> bool {
                match self {
                    $(Column::$Figure => a.$figure == b.$figure,)+
                    $(Column::$Origin => a.$origin == b.$origin,)+
                }
            }

            fn cell(self, row: &Row) -> Value<'_> {
                match self {
                    $(Column::$Figure => row.$figure.value(),)+
                    $(Column::$Origin => row.$origin.value(),)+
                }
            }
        }

        impl Row {
            fn share(&mut self, texts: &mut std::collections::HashSet<Text>) {
                $(self.$figure.share(texts);)+
                $(self.$origin.share(texts);)+
            }
        }
    };
}

pub(super) use columns;
