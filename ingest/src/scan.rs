//! The fields of a few columns of comma-separated values, record by record, out of bytes that are in memory. Nothing is
//! copied: a mission has some ten thousand records of 26 columns, of which seven are asked for.
//!
//! Separators are found 64 bytes at a time: a comparison gives a bit for each byte, and the exclusive or of all quotes up to a
//! byte says whether it stands in quotes (Langdale and Lemire 2019, doi 10.1007/s00778-019-00578-5).

mod places;

use places::{BLOCK, Places, WithPlaces, with_places};

use crate::files::{LONGEST_LINE, MAX_BYTES, check_lines};
use crate::{Finding, FindingKind};

// Places are `u32`, of which eight or sixteen fit a register.
const _: () = assert!(MAX_BYTES < u32::MAX as u64 / 2);

/// Fields that are looked for at a time.
const BATCH: usize = 1024;

/// Records below a header.
pub(crate) struct Scanner<'b, const N: usize> {
    bytes: &'b [u8],
    /// What stands between two fields.
    separator: u8,
    /// The wanted column of each wanted field, or one that no record has.
    places: [usize; N],
    /// Where the next block begins.
    at: usize,
    /// All ones inside quotes.
    inside: u64,
    /// Whether a separator stands before the block.
    after_separator: bool,
    /// Where fields begin, those of records that are done first; the last one may be without an end so far.
    starts: Vec<u32>,
    /// How many of them are known; behind those lies what no longer counts.
    known: usize,
    /// Places in `starts` of the first fields of records, but for the first.
    firsts: Vec<usize>,
    /// Whether there are line breaks in quotes.
    has_inner: bool,
    /// How many records are done of `firsts`, and where the next one begins in `starts`.
    done: usize,
    first: usize,
    /// The line of the next record, and whether it is longer than is read.
    line: u64,
    is_too_long: bool,
    quotes: Quotes,
}

/// What is wrong with quotes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Quotes {
    /// Each begins or ends its field so far.
    Fine,
    /// One stands in a field that does not begin with one.
    Odd(usize),
}

/// A record: where it begins, and the wanted fields, as they stand there without their quotes. A column that the file or the
/// record has not is empty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Record<'b, const N: usize> {
    pub line: u64,
    /// Where it stands in the bytes, its line break included.
    pub start: usize,
    pub end: usize,
    pub fields: [&'b [u8]; N],
}

impl<'b, const N: usize> Scanner<'b, N> {
    /// `places` are the positions of the wanted columns; the first record of `bytes` is the header.
    pub fn new(bytes: &'b [u8], separator: u8, places: &[Option<usize>; N]) -> Self {
        let mut scanner = Self {
            bytes,
            separator,
            places: places.map(|place| place.unwrap_or(usize::MAX - 1)),
            at: 0,
            inside: 0,
            after_separator: true,
            starts: vec![0; BATCH + BLOCK + 1],
            known: 1,
            firsts: Vec::new(),
            has_inner: false,
            done: 0,
            first: 0,
            line: 1,
            is_too_long: false,
            quotes: Quotes::Fine,
        };
        scanner.next();
        scanner
    }

    /// Whether all is well, once so many records are through, all of them or two more than may be.
    ///
    /// # Errors
    /// Too many records, or too long ones; quotes that never close or stand where none can; no record at all.
    pub fn check(&self, records: usize, most: usize) -> Result<(), Finding> {
        if records > most + 1 || self.is_too_long {
            check_lines(self.bytes, self.separator, most)?;
        }
        if let Some(line) = self.bad_quote() {
            let message =
                "a quote never closes, or stands in a field that does not begin with one; export the file again";
            return Err(Finding::whole(FindingKind::Unreadable, message).at_line(line));
        }
        if self.is_too_long {
            check_lines(self.bytes, self.separator, most)?;
            let message = format!(
                "a row of several lines has more than {LONGEST_LINE} bytes; look for a quote that never closes"
            );
            return Err(Finding::whole(FindingKind::Unreadable, message).at_line(self.line));
        }
        if records == 0 {
            return Err(Finding::whole(FindingKind::Empty, "there are no rows below the header").at_line(2));
        }
        Ok(())
    }

    /// The line of a quote that never closes or stands where none can.
    fn bad_quote(&self) -> Option<u64> {
        let at = match self.quotes {
            Quotes::Odd(at) => at,
            // What is open at the end was opened by the last one.
            Quotes::Fine if self.inside != 0 => memchr::memrchr(b'"', &self.bytes[..self.at.min(self.bytes.len())])?,
            Quotes::Fine => return None,
        };
        Some(1 + memchr::memchr_iter(b'\n', &self.bytes[..at]).count() as u64)
    }

    /// Finds more fields, until a record is whole; false where there are none, or none that is read.
    #[cold]
    fn find_more(&mut self) -> bool {
        self.starts.copy_within(self.first..self.known, 0);
        self.known -= self.first;
        self.first = 0;
        self.done = 0;
        self.firsts.clear();
        with_places(Blocks(self));
        let start = self.starts[0] as usize;
        self.is_too_long = self.firsts.is_empty() && self.at.min(self.bytes.len()) > start + LONGEST_LINE;
        if self.is_too_long {
            return false;
        }
        if self.at >= self.bytes.len() && self.firsts.is_empty() && start < self.bytes.len() {
            // The last record need not end in a line break.
            self.starts[self.known] = self.bytes.len() as u32 + 1;
            self.firsts.push(self.known);
            self.known += 1;
        }
        !self.firsts.is_empty()
    }

    #[inline(always)]
    fn block(&mut self, places: impl Places) {
        let rest = &self.bytes[self.at..];
        let block = rest.first_chunk().copied().unwrap_or_else(|| {
            let mut padded = [0; BLOCK];
            padded[..rest.len()].copy_from_slice(rest);
            padded
        });
        let [commas, newlines, quotes] = [self.separator, b'\n', b'"'].map(|byte| places.equal(&block, byte));
        let before = self.inside;
        let mut inside = 0;
        if quotes != 0 || before != 0 {
            inside = prefix_xor(quotes) ^ before;
            self.check_quotes(quotes, inside, (commas | newlines) & !inside);
            self.has_inner |= newlines & inside != 0;
        }
        let (separators, ends) = ((commas | newlines) & !inside, newlines & !inside);
        self.inside = if inside >> (BLOCK - 1) == 1 { u64::MAX } else { 0 };
        self.after_separator = separators >> (BLOCK - 1) == 1;
        if self.starts.len() <= self.known + BLOCK {
            // A record of very many fields.
            self.starts.resize(2 * self.starts.len(), 0);
        }
        if let Some(out) = self.starts[self.known..].first_chunk_mut() {
            places.write(separators, self.at as u32 + 1, out);
        }
        for end in ones(ends) {
            self.firsts.push(self.known + (separators & ((1 << end) - 1)).count_ones() as usize);
        }
        self.known += separators.count_ones() as usize;
        self.at += BLOCK;
    }

    /// A quote that opens begins its field, or follows the one that seemed to close it.
    #[inline(always)]
    fn check_quotes(&mut self, quotes: u64, inside: u64, separators: u64) {
        let opens = quotes & inside;
        let closes_before = (quotes & !inside) << 1;
        let begins = (separators << 1) | u64::from(self.after_separator) | closes_before;
        let first_may_follow = u64::from(self.at > 0 && self.bytes[self.at - 1] == b'"');
        let odd = opens & !(begins | first_may_follow);
        if odd != 0 && self.quotes == Quotes::Fine {
            self.quotes = Quotes::Odd(self.at + odd.trailing_zeros() as usize);
        }
    }
}

/// Blocks of a scanner, until its batch is full and a record is whole, or is longer than is read.
struct Blocks<'s, 'b, const N: usize>(&'s mut Scanner<'b, N>);

impl<const N: usize> WithPlaces for Blocks<'_, '_, N> {
    #[inline(always)]
    fn call(self, places: impl Places) {
        let Self(scanner) = self;
        let longest = scanner.starts[0] as usize + LONGEST_LINE + BLOCK;
        while scanner.at < scanner.bytes.len().min(longest) && (scanner.known < BATCH || scanner.firsts.is_empty()) {
            scanner.block(places);
        }
    }
}

impl<'b, const N: usize> Iterator for Scanner<'b, N> {
    type Item = Record<'b, N>;

    #[inline(always)]
    fn next(&mut self) -> Option<Record<'b, N>> {
        if self.is_too_long || self.done == self.firsts.len() && !self.find_more() {
            return None;
        }
        let next = self.firsts[self.done];
        // Each field ends before the separator in front of the next one.
        let starts = &self.starts[self.first..=next];
        let (start, end) = (starts[0] as usize, starts[starts.len() - 1] as usize - 1);
        if end - start > LONGEST_LINE {
            self.is_too_long = true;
            return None;
        }
        let text_end = if self.bytes[start..end].ends_with(b"\r") { end - 1 } else { end };
        let mut record =
            Record { line: self.line, start, end: (end + 1).min(self.bytes.len()), fields: [b"".as_slice(); N] };
        for (field, place) in record.fields.iter_mut().zip(self.places) {
            if let Some(&[from, behind]) = starts.get(place..).and_then(|rest| rest.first_chunk()) {
                *field = unquoted(&self.bytes[from as usize..text_end.min(behind as usize - 1)]);
            }
        }
        self.line += 1;
        if self.has_inner {
            self.line += memchr::memchr_iter(b'\n', &self.bytes[start..end]).count() as u64;
        }
        self.first = next;
        self.done += 1;
        Some(record)
    }
}

/// A field without its quotes.
#[inline(always)]
fn unquoted(field: &[u8]) -> &[u8] {
    match field {
        [b'"', text @ .., b'"'] | [b'"', text @ ..] => text,
        _ => field,
    }
}

/// The exclusive or of all bits up to each.
#[inline]
fn prefix_xor(bits: u64) -> u64 {
    [1, 2, 4, 8, 16, 32].into_iter().fold(bits, |bits, shift| bits ^ (bits << shift))
}

/// The places of the bits that are set.
#[inline]
fn ones(mut bits: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = (bits != 0).then(|| bits.trailing_zeros() as usize)?;
        bits &= bits - 1;
        Some(bit)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use polars::prelude::{CsvParseOptions, CsvReadOptions, SerReader};
    use proptest::prelude::*;
    use std::io::Cursor;
    use std::path::PathBuf;

    /// All fields of all records, by polars.
    fn oracle(bytes: &[u8]) -> Vec<Vec<String>> {
        let frame = CsvReadOptions::default()
            .with_infer_schema_length(Some(0))
            .with_parse_options(CsvParseOptions::default().with_missing_is_null(false))
            .into_reader_with_file_handle(Cursor::new(bytes))
            .finish()
            .unwrap();
        let text =
            |column: &polars::prelude::Column, row: usize| column.str().unwrap().get(row).unwrap_or("").to_owned();
        (0..frame.height()).map(|row| frame.columns().iter().map(|column| text(column, row)).collect()).collect()
    }

    fn scanned<const N: usize>(bytes: &[u8], places: [Option<usize>; N]) -> Vec<(u64, Vec<String>)> {
        let text = |field: &&[u8]| String::from_utf8_lossy(field).replace("\"\"", "\"");
        Scanner::new(bytes, b',', &places).map(|r| (r.line, r.fields.iter().map(text).collect())).collect()
    }

    #[test]
    fn xval_polars_the_real_mission_has_the_same_fields() {
        let beside = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
        let data = std::env::var_os("BUSCLIMATE_DATA").map_or_else(beside, PathBuf::from);
        let Ok(bytes) = std::fs::read(data.join("ztbus/B183_2021-07-26_03-53-27_2021-07-26_07-18-47.csv")) else {
            return;
        };
        let theirs = oracle(&bytes);
        assert_eq!(theirs.len(), 12_321);
        let places = [Some(1), Some(8), Some(19), Some(23), Some(12), Some(2), Some(7), None];
        for (row, (line, ours)) in scanned(&bytes, places).into_iter().enumerate() {
            let wanted = [1, 8, 19, 23, 12, 2, 7].map(|place: usize| theirs[row][place].clone());
            assert_eq!((ours[..7].to_vec(), line), (wanted.to_vec(), row as u64 + 2));
            assert_eq!(ours[7], "");
        }
    }

    #[test]
    fn prop_lines_count_right_and_a_quote_that_never_closes_is_known() {
        let text = b"a,b,c\n1,\"x\n,\"\"y\"\"\",3\n4,5\n,,6\n7,\"8\n";
        let places = [Some(2), Some(0)];
        let expected: Vec<(u64, Vec<String>)> = [(2, ["3", "1"]), (4, ["", "4"]), (5, ["6", ""]), (6, ["", "7"])]
            .map(|(line, fields)| (line, fields.map(str::to_owned).to_vec()))
            .to_vec();
        assert_eq!(scanned(text, places), expected);
        let mut scanner = Scanner::new(text, b',', &places);
        assert_eq!((scanner.by_ref().count(), scanner.bad_quote()), (4, Some(6)));
    }

    #[test]
    fn prop_as_many_fields_are_read_as_a_line_may_have_and_no_more() {
        let refused = |row: &str, most| {
            let text = format!("a,b\n1,2\n{row}\n3,4\n");
            let mut scanner = Scanner::new(text.as_bytes(), b',', &[Some(1)]);
            let records = scanner.by_ref().take(most + 2).count();
            (records, scanner.check(records, most).err().map(|finding| (finding.line, finding.message)))
        };
        assert_eq!(refused(&",".repeat(LONGEST_LINE), 9), (3, None));
        assert_eq!(refused(&format!("\"{0}\n{0}\"", "x".repeat(LONGEST_LINE / 2 - 2)), 9), (3, None));
        let (records, finding) = refused(&",".repeat(LONGEST_LINE + 1), 9);
        assert_eq!(
            (records, finding),
            (1, Some((Some(3), "a line of 65537 bytes; at most 65536 are read".to_owned())))
        );
        let (records, finding) = refused(&format!("\"{0}\n{0}\"", "x".repeat(LONGEST_LINE / 2)), 9);
        assert_eq!((records, finding.map(|f| f.0)), (1, Some(Some(3))));
        let (records, finding) = refused("5,6\n7,8", 2);
        assert_eq!((records, finding), (4, Some((Some(4), "more than 2 rows; no such file holds as many".to_owned()))));
    }

    proptest! {
        #[test]
        fn xval_polars_tables_have_the_same_fields(
            rows in prop::collection::vec(prop::collection::vec("([a-z0-9.]{0,6}|\"[a-z,\n]{0,5}(\"\"[a-z]{0,3}\"\")?[a-z]{0,2}\")", 5), 1..20),
            places in prop::array::uniform3(prop::option::of(0_usize..5)),
            newline in prop_oneof![Just("\n"), Just("\r\n")],
        ) {
            let rows: Vec<String> = rows.iter().map(|row| format!("r,{}{newline}", row.join(","))).collect();
            let text = format!("k,a,b,c,d,e{newline}{}", rows.concat());
            let [a, b, c] = places;
            let places = [a, b.filter(|_| b != a), c.filter(|_| c != a && c != b)];
            let theirs = oracle(text.as_bytes());
            let ours = scanned(text.as_bytes(), places.map(|place| place.map(|p| p + 1)));
            prop_assert_eq!(ours.len(), theirs.len());
            for ((_, ours), theirs) in ours.iter().zip(&theirs) {
                for (field, place) in ours.iter().zip(places) {
                    let wanted = place.map_or("", |place| &theirs[place + 1]);
                    prop_assert_eq!(field.trim_end_matches('\r'), wanted);
                }
            }
        }

        #[test]
        fn prop_any_bytes_end(bytes in prop::collection::vec(prop_oneof![Just(b'"'), Just(b','), Just(b'\n'), any::<u8>()], 0..300)) {
            let newlines = bytes.iter().filter(|b| **b == b'\n').count() as u64;
            for record in Scanner::new(&bytes, b',', &[Some(0), Some(3)]) {
                prop_assert!(record.line <= newlines + 1);
            }
        }
    }
}
