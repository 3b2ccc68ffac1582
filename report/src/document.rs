//! What a report consists of, before anything is rendered: sections with prose, tables and figures as data.

/// A section. Its blocks come one after the other; `tables` are those that spreadsheets get, with every digit.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Section {
    /// 1 for the title of the report, 2 for a section, 3 for a part of one, 0 for one that goes on without a title.
    pub level: usize,
    pub title: String,
    pub blocks: Vec<Block>,
    pub tables: Vec<DataTable>,
    pub figures: Vec<Figure>,
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
    /// A figure of the section, by its file.
    Figure {
        file: &'static str,
        caption: &'static str,
    },
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
    pub file: &'static str,
    pub columns: Vec<&'static str>,
    pub rows: Vec<Vec<String>>,
}

/// A figure, drawn.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Figure {
    pub file: &'static str,
    pub svg: String,
}

impl Section {
    pub fn new(title: impl Into<String>) -> Self {
        Self { level: 2, title: title.into(), ..Self::default() }
    }

    /// A figure, drawn, at this place of the text.
    pub fn with_figure(mut self, file: &'static str, caption: &'static str, svg: String) -> Self {
        self.figures.push(Figure { file, svg });
        self.with(Block::Figure { file, caption })
    }

    pub fn with(mut self, block: impl Into<Option<Block>>) -> Self {
        self.blocks.extend(block.into());
        self
    }
}

impl Block {
    /// A paragraph of words without marks.
    pub fn words(text: &'static str) -> Self {
        Self::Paragraph(vec![Span::Text(text)])
    }
}

impl Table {
    /// A table with the given columns, first words, then numbers.
    pub fn new(words: &[&str], numbers: &[&str], rows: Vec<Vec<String>>) -> Self {
        let words = words.iter().map(|c| Column::Words((*c).to_owned()));
        let numbers = numbers.iter().map(|c| Column::Numbers((*c).to_owned()));
        Self { columns: words.chain(numbers).collect(), rows }
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
            file,
            columns: columns.iter().map(|(name, _)| *name).collect(),
            rows: rows.into_iter().map(|row| columns.iter().map(|(_, cell)| cell(row)).collect()).collect(),
        }
    }
}
