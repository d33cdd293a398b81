//! The last value of a computation, kept with its key.

use std::convert::Infallible;

/// A value computed anew only when its key `K` changes.
pub struct Memo<K, V>(Option<(K, V)>);

impl<K, V> Default for Memo<K, V> {
    fn default() -> Self {
        Memo(None)
    }
}

impl<K: PartialEq, V> Memo<K, V> {
    /// The value of `key`: the last one, where its key is equal.
    pub fn of(&mut self, key: K, make: impl FnOnce(&K) -> V) -> &mut V {
        match self.try_of(key, |key| Ok::<V, Infallible>(make(key))) {
            Ok(value) => value,
            Err(never) => match never {},
        }
    }

    /// The same for a computation that may fail; a failure leaves no value.
    ///
    /// # Errors
    /// Those of `make`.
    pub fn try_of<E>(&mut self, key: K, make: impl FnOnce(&K) -> Result<V, E>) -> Result<&mut V, E> {
        let kept = match self.0.take() {
            Some(kept) if kept.0 == key => kept,
            _ => {
                let value = make(&key)?;
                (key, value)
            }
        };
        Ok(&mut self.0.insert(kept).1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_made_once_a_key() {
        let (mut memo, mut made) = (Memo::default(), 0);
        for key in [2, 2, 3, 2] {
            let square = *memo.of(key, |key| {
                made += 1;
                key * key
            });
            assert_eq!(square, key * key);
        }
        assert_eq!(made, 3);
        assert_eq!(memo.try_of(4, |_| Err("none")), Err("none"));
        assert_eq!(memo.of(2, |_| 5), &5, "what failed leaves nothing behind");
    }
}
