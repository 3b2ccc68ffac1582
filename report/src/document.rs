//! What a report consists of, before anything is rendered: sections with prose, tables and figures as data.

use crate::figure::{Bars, Chart, HeatFlowFigure};

/// A section. Its blocks come one after the other; `tables` are those that spreadsheets get, with every digit.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Section {
    /// 1 for the title of the report, 2 for a section, 3 for a part of one, 0 for one that goes on without a title.
    pub level: usize,
    pub title: String,
    /// What the section answers.
    pub question: Prose,
    pub blocks: Vec<Block>,
    pub tables: Vec<DataTable>,
}

/// A piece of a section.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Block {
    Paragraph(Prose),
    /// A remark on what stands before it.
    Note(Prose),
    /// Somebody else's words.
    Quote(Prose),
    List(Vec<Prose>),
    Table(Table),
    Figure(Figure),
    /// What a reader may conclude.
    Means(Prose),
    /// What a reader may not conclude.
    Limits(Prose),
    /// The same of several things, of which a reader chooses one.
    Choice(Choice),
}

/// The same blocks of several things; where nobody can choose, those of the one `shown`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Choice {
    /// What is chosen.
    pub of: &'static str,
    pub options: Vec<(String, Vec<Block>)>,
    pub shown: usize,
}

/// A figure, before it is drawn.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Figure {
    /// Its files without an ending.
    pub file: &'static str,
    pub caption: String,
    pub picture: Picture,
}

/// What there is to draw.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Picture {
    Chart(Box<Chart>),
    Bars(Box<Bars>),
    HeatFlow(Box<HeatFlowFigure>),
}

/// Text with marks.
pub(crate) type Prose = Vec<Span>;

/// A piece of text.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Span {
    /// Words of this program, with its line breaks.
    Text(&'static str),
    /// A value, or text from outside: whatever it holds, it stays on its line.
    Value(String),
    Strong(String),
    Code(&'static str),
}

/// A table to be read: rounded numbers with their units in words.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Table {
    pub columns: Vec<Column>,
    pub rows: Vec<Vec<String>>,
    /// The table of data that it shows.
    pub file: &'static str,
}

/// A column: words stand left, numbers right.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Column {
    Words(String),
    Numbers(String),
}

/// A column of a table of data: its name, and what it says of a row.
pub(crate) type DataColumn<'c, T> = (&'static str, &'c dyn Fn(&T) -> String);

/// A table to compute with.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DataTable {
    pub file: String,
    pub columns: Vec<&'static str>,
    pub rows: Vec<Vec<String>>,
}

impl Section {
    pub fn new(title: impl Into<String>) -> Self {
        Self { level: 2, title: title.into(), ..Self::default() }
    }

    /// The question that the section answers.
    pub fn asking(mut self, question: &'static str) -> Self {
        self.question = vec![Span::Text(question)];
        self
    }

    pub fn with(mut self, block: impl Into<Option<Block>>) -> Self {
        self.blocks.extend(block.into());
        self
    }

    /// A chart, drawn at this place of the text.
    pub fn with_chart(self, file: &'static str, caption: impl Into<String>, chart: Chart) -> Self {
        self.with(Block::chart(file, caption, chart))
    }

    /// All figures that are shown where nobody chooses.
    pub fn figures(&self) -> Vec<&Figure> {
        fn of(blocks: &[Block]) -> Vec<&Figure> {
            let each = blocks.iter().map(|block| match block {
                Block::Figure(figure) => vec![figure],
                Block::Choice(choice) => choice.options.get(choice.shown).map_or_else(Vec::new, |o| of(&o.1)),
                _ => Vec::new(),
            });
            each.flatten().collect()
        }
        of(&self.blocks)
    }
}

impl Block {
    /// A paragraph of words without marks.
    pub fn words(text: &'static str) -> Self {
        Self::Paragraph(vec![Span::Text(text)])
    }

    /// What it means, in words without marks.
    pub fn means(text: &'static str) -> Self {
        Self::Means(vec![Span::Text(text)])
    }

    /// What it does not say, in words without marks.
    pub fn limits(text: &'static str) -> Self {
        Self::Limits(vec![Span::Text(text)])
    }

    pub fn chart(file: &'static str, caption: impl Into<String>, chart: Chart) -> Self {
        Self::Figure(Figure { file, caption: caption.into(), picture: Picture::Chart(Box::new(chart)) })
    }

    pub fn bars(file: &'static str, caption: impl Into<String>, bars: Bars) -> Self {
        Self::Figure(Figure { file, caption: caption.into(), picture: Picture::Bars(Box::new(bars)) })
    }
}

impl Table {
    /// A table with the given columns, first words, then numbers, and the file that has all of it.
    pub fn new(file: &'static str, words: &[&str], numbers: &[&str], rows: Vec<Vec<String>>) -> Self {
        let words = words.iter().map(|c| Column::Words((*c).to_owned()));
        let numbers = numbers.iter().map(|c| Column::Numbers((*c).to_owned()));
        Self { columns: words.chain(numbers).collect(), rows, file }
    }
}

impl Column {
    pub fn title(&self) -> &str {
        match self {
            Self::Words(title) | Self::Numbers(title) => title,
        }
    }
}

impl DataTable {
    /// A table of rows: each column has its name beside what it says of a row.
    pub fn of<'r, T: 'r>(
        file: &'static str,
        rows: impl IntoIterator<Item = &'r T>,
        columns: &[DataColumn<'_, T>],
    ) -> Self {
        Self {
            file: file.to_owned(),
            columns: columns.iter().map(|(name, _)| *name).collect(),
            rows: rows.into_iter().map(|row| columns.iter().map(|(_, cell)| cell(row)).collect()).collect(),
        }
    }
}
