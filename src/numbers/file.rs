//! Numbers in files: in text files infinity and NaN, which JSON lacks, are the words "inf", "-inf" and "NaN".

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A number that is read from a file, as a number or as the word "inf", "-inf" or "NaN".
pub(crate) struct Written(f64);

impl Serialize for Written {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        if self.0.is_finite() || !to.is_human_readable() {
            to.serialize_f64(self.0)
        } else {
            to.collect_str(&self.0)
        }
    }
}

impl<'de> Deserialize<'de> for Written {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Found {
            Number(f64),
            Word(String),
        }
        if !from.is_human_readable() {
            return f64::deserialize(from).map(Self);
        }
        match Found::deserialize(from)? {
            Found::Number(x) => Ok(Self(x)),
            Found::Word(word) => word.parse().map(Self).map_err(D::Error::custom),
        }
    }
}

pub(crate) fn serialize<S: Serializer>(x: &f64, to: S) -> Result<S::Ok, S::Error> {
    Written(*x).serialize(to)
}

pub(crate) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Written::deserialize(from).map(|x| x.0)
}

/// Conversion of rows of numbers in files, with the words "inf", "-inf" and "NaN" for infinity and NaN.
pub(crate) mod rows {
    use super::Written;
    use serde::{Deserialize, Deserializer, Serializer};

    pub(crate) fn serialize<T, S: Serializer>(rows: &[T], to: S) -> Result<S::Ok, S::Error>
    where
        T: Copy + Into<[f64; 5]>,
    {
        to.collect_seq(rows.iter().map(|row| (*row).into().map(Written)))
    }

    pub(crate) fn deserialize<'de, T, D: Deserializer<'de>>(from: D) -> Result<Vec<T>, D::Error>
    where
        T: From<[f64; 5]>,
    {
        let rows = Vec::<[Written; 5]>::deserialize(from)?;
        Ok(rows.into_iter().map(|row| row.map(|x| x.0).into()).collect())
    }
}
