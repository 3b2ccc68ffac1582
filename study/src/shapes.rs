//! Values of a study file that are a list of some length, or in another shape a number, a name or a table.
//!
//! An error inside of a list or table keeps its own line and column, which reading any shape first and looking at it later
//! would lose.

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Unexpected, Visitor};
use std::fmt;
use std::marker::PhantomData;

use crate::file::{Cop, Limit, Limits, Override, Pair, Spread};

/// A value that is a list or something else.
trait ListOr: Sized {
    /// What an error says that the value can be.
    const EXPECTED: &'static str;

    fn list<'de, A: SeqAccess<'de>>(list: SeqAccessDeserializer<A>) -> Result<Self, A::Error>;

    fn table<'de, A: MapAccess<'de>>(_: MapAccessDeserializer<A>) -> Result<Self, A::Error> {
        Err(A::Error::invalid_type(Unexpected::Map, &Self::EXPECTED))
    }

    fn number(_: f64) -> Option<Self> {
        None
    }

    fn name(_: &str) -> Option<Self> {
        None
    }
}

struct Shapes<T>(PhantomData<T>);

impl<'de, T: ListOr> Visitor<'de> for Shapes<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(T::EXPECTED)
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<T, E> {
        T::number(value).ok_or_else(|| E::invalid_type(Unexpected::Float(value), &self))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<T, E> {
        T::number(value as f64).ok_or_else(|| E::invalid_type(Unexpected::Signed(value), &self))
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<T, E> {
        T::name(value).ok_or_else(|| E::invalid_type(Unexpected::Str(value), &self))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<T, A::Error> {
        T::list(SeqAccessDeserializer::new(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<T, A::Error> {
        T::table(MapAccessDeserializer::new(map))
    }
}

impl ListOr for Pair {
    const EXPECTED: &'static str = "two numbers, as in [low, high] or [lift in K, COP]";

    fn list<'de, A: SeqAccess<'de>>(list: SeqAccessDeserializer<A>) -> Result<Self, A::Error> {
        let numbers: Vec<f64> = Vec::deserialize(list)?;
        match numbers[..] {
            [first, second] => Ok(Self(first, second)),
            _ => Err(A::Error::invalid_length(numbers.len(), &Self::EXPECTED)),
        }
    }
}

impl ListOr for Limits {
    const EXPECTED: &'static str = "{ from = 0.0, to = 2.0, step = 0.125 } or a list such as [0.25, 1.0]";

    fn list<'de, A: SeqAccess<'de>>(list: SeqAccessDeserializer<A>) -> Result<Self, A::Error> {
        Vec::deserialize(list).map(Self::List)
    }

    fn table<'de, A: MapAccess<'de>>(table: MapAccessDeserializer<A>) -> Result<Self, A::Error> {
        Deserialize::deserialize(table).map(Self::Steps)
    }
}

impl ListOr for Spread {
    const EXPECTED: &'static str = "[low, high], { mean = 1.0, sd = 0.1 } or { low = 0.8, mode = 1.0, high = 1.1 }";

    fn list<'de, A: SeqAccess<'de>>(list: SeqAccessDeserializer<A>) -> Result<Self, A::Error> {
        Pair::deserialize(list).map(Self::Ends)
    }

    fn table<'de, A: MapAccess<'de>>(table: MapAccessDeserializer<A>) -> Result<Self, A::Error> {
        Deserialize::deserialize(table).map(Self::Named)
    }
}

impl ListOr for Cop {
    const EXPECTED: &'static str = "the name of a COP curve, or a table such as [[0.0, 4.4], [20.0, 2.0]]";

    fn list<'de, A: SeqAccess<'de>>(list: SeqAccessDeserializer<A>) -> Result<Self, A::Error> {
        Vec::deserialize(list).map(Self::Table)
    }

    fn name(name: &str) -> Option<Self> {
        Some(Self::Name(name.to_owned()))
    }
}

impl ListOr for Limit {
    const EXPECTED: &'static str =
        "a number of W, or a table of [ambient temperature in °C, W] such as [[-20.0, 6e3], [10.0, 12e3]]";

    fn list<'de, A: SeqAccess<'de>>(list: SeqAccessDeserializer<A>) -> Result<Self, A::Error> {
        Vec::deserialize(list).map(Self::Table)
    }

    fn number(value: f64) -> Option<Self> {
        Some(Self::Constant(value))
    }
}

impl ListOr for Override {
    const EXPECTED: &'static str = "a number, or under `designs` a list of names";

    fn list<'de, A: SeqAccess<'de>>(list: SeqAccessDeserializer<A>) -> Result<Self, A::Error> {
        Vec::deserialize(list).map(Self::Designs)
    }

    fn number(value: f64) -> Option<Self> {
        Some(Self::Value(value))
    }
}

macro_rules! deserialize {
    ($($shape:ty),+) => {$(
        impl<'de> Deserialize<'de> for $shape {
            fn deserialize<D: Deserializer<'de>>(source: D) -> Result<Self, D::Error> {
                source.deserialize_any(Shapes(PhantomData))
            }
        }
    )+};
}

deserialize!(Pair, Limits, Spread, Cop, Limit, Override);
