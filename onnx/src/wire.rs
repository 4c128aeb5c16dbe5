//! A first look at the bytes, before anything is built from them.
//!
//! An ONNX file is a protobuf message. A decoder turns two bytes of a hostile file into an empty
//! record of some hundred bytes, and reports a cut file as just another fault. So the outer levels
//! are walked here without allocating: fields must end where the file says, only the weights and
//! the metadata may be large, and the metadata is read at once, so that a file that is no generator
//! is refused by the name of the key that it lacks.

use crate::Error;

/// Most bytes outside weights and metadata values: nodes, names, attributes. A generator needs
/// about 20 kB; the bound keeps what a decoder allocates below some 100 MB.
const MAX_STRUCTURE_BYTES: usize = 1 << 20;
/// Most metadata entries.
const MAX_METADATA: usize = 256;

/// Field numbers of onnx.proto3.
mod number {
    pub const MODEL_GRAPH: u64 = 7;
    pub const MODEL_METADATA: u64 = 14;
    pub const MODEL_TRAINING: u64 = 20;
    pub const MODEL_FUNCTIONS: u64 = 25;
    pub const GRAPH_INITIALIZER: u64 = 5;
    pub const TENSOR_RAW_DATA: u64 = 9;
    pub const ENTRY_KEY: u64 = 1;
    pub const ENTRY_VALUE: u64 = 2;
}

/// One key and one value of the metadata.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Entry<'a> {
    pub key: &'a str,
    pub value: &'a str,
}

/// Walks the outer levels of a model and returns its metadata. Errors: [`Error::Truncated`],
/// [`Error::NotOnnx`], [`Error::Metadata`] (not UTF-8), [`Error::Graph`] (training or functions).
pub(crate) fn metadata(bytes: &[u8]) -> Result<Vec<Entry<'_>>, Error> {
    if bytes.is_empty() {
        return Err(not_onnx("the file is empty"));
    }
    let mut entries = Vec::new();
    let mut graphs = 0;
    let mut bulk = 0usize;
    let mut model = Reader::file(bytes);
    while let Some((field, value)) = model.field()? {
        match (field, value) {
            (number::MODEL_GRAPH, Some(graph)) => {
                graphs += 1;
                bulk += weight_bytes(graph)?;
            }
            (number::MODEL_METADATA, Some(entry)) => {
                if entries.len() == MAX_METADATA {
                    return Err(not_onnx("more than 256 metadata entries"));
                }
                bulk += entry.len();
                entries.push(read_entry(entry)?);
            }
            (number::MODEL_TRAINING | number::MODEL_FUNCTIONS, _) => {
                return Err(Error::Graph {
                    reason: "training graphs and functions do not belong into a generator file".into(),
                });
            }
            (number::MODEL_GRAPH | number::MODEL_METADATA, None) => {
                return Err(not_onnx("the graph or the metadata is not a message"));
            }
            _ => {}
        }
    }
    if graphs > 1 {
        return Err(not_onnx("more than one graph"));
    }
    if bytes.len() - bulk > MAX_STRUCTURE_BYTES {
        return Err(not_onnx("more than 1 MB beside weights and metadata"));
    }
    Ok(entries)
}

fn weight_bytes(graph: &[u8]) -> Result<usize, Error> {
    let mut bytes = 0;
    let mut graph = Reader::nested(graph);
    while let Some((field, value)) = graph.field()? {
        if let (number::GRAPH_INITIALIZER, Some(tensor)) = (field, value) {
            let mut tensor = Reader::nested(tensor);
            while let Some((field, value)) = tensor.field()? {
                if let (number::TENSOR_RAW_DATA, Some(raw)) = (field, value) {
                    bytes += raw.len();
                }
            }
        }
    }
    Ok(bytes)
}

fn read_entry(bytes: &[u8]) -> Result<Entry<'_>, Error> {
    let (mut key, mut value): (&[u8], &[u8]) = (&[], &[]);
    let mut reader = Reader::nested(bytes);
    while let Some((field, text)) = reader.field()? {
        match (field, text) {
            (number::ENTRY_KEY, Some(text)) => key = text,
            (number::ENTRY_VALUE, Some(text)) => value = text,
            _ => {}
        }
    }
    let utf8 = |text, what: &str| {
        std::str::from_utf8(text).map_err(|e| Error::Metadata {
            key: String::from_utf8_lossy(key).into_owned(),
            reason: format!("the {what} is not UTF-8 at its byte {}", e.valid_up_to()),
        })
    };
    Ok(Entry { key: utf8(key, "key")?, value: utf8(value, "value")? })
}

fn not_onnx(reason: &str) -> Error {
    Error::NotOnnx { reason: reason.into() }
}

/// Reads the fields of one protobuf message.
struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Whether this is the whole file, where a field that runs past the end means a cut file;
    /// within a message it means nonsense.
    whole: bool,
}

/// A field: its number, and its bytes where it has a length.
type Field<'a> = (u64, Option<&'a [u8]>);

impl<'a> Reader<'a> {
    fn file(bytes: &'a [u8]) -> Self {
        Reader { bytes, at: 0, whole: true }
    }

    fn nested(bytes: &'a [u8]) -> Self {
        Reader { bytes, at: 0, whole: false }
    }

    /// The next field: its number and, where it has a length, its bytes. None at the end.
    fn field(&mut self) -> Result<Option<Field<'a>>, Error> {
        if self.at == self.bytes.len() {
            return Ok(None);
        }
        let start = self.at;
        let tag = self.varint(start)?;
        let (number, wire_type) = (tag >> 3, tag & 7);
        if number == 0 || number > (1 << 29) - 1 {
            return Err(Error::NotOnnx { reason: format!("no protobuf field at byte {start}") });
        }
        let value = match wire_type {
            0 => {
                self.varint(start)?;
                None
            }
            1 => {
                self.take(8, start)?;
                None
            }
            2 => {
                let length = self.varint(start)?;
                Some(self.take(length, start)?)
            }
            5 => {
                self.take(4, start)?;
                None
            }
            _ => {
                return Err(Error::NotOnnx { reason: format!("no protobuf field at byte {start}") });
            }
        };
        Ok(Some((number, value)))
    }

    fn varint(&mut self, start: usize) -> Result<u64, Error> {
        let mut value = 0u64;
        for shift in (0..64).step_by(7) {
            let byte = self.take(1, start)?[0];
            value |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Ok(value);
            }
        }
        Err(Error::NotOnnx { reason: format!("a number of more than 64 bits at byte {start}") })
    }

    fn take(&mut self, length: u64, start: usize) -> Result<&'a [u8], Error> {
        let left = self.bytes.len() - self.at;
        if length > left as u64 {
            let missing = length - left as u64;
            return Err(if self.whole {
                Error::Truncated { offset: start, missing }
            } else {
                Error::NotOnnx { reason: "a field is longer than the message around it".into() }
            });
        }
        // fits usize: it is at most `left`
        let taken = &self.bytes[self.at..self.at + length as usize];
        self.at += length as usize;
        Ok(taken)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A field with a length: tag, length (below 128), bytes.
    fn field(number: u8, bytes: &[u8]) -> Vec<u8> {
        let mut out = vec![number << 3 | 2, bytes.len() as u8];
        out.extend_from_slice(bytes);
        out
    }

    #[test]
    fn reads_metadata() {
        let entry = [field(1, b"key"), field(2, b"value")].concat();
        let file = [vec![0x08, 0x08], field(14, &entry), field(7, &[])].concat();
        assert_eq!(metadata(&file).unwrap(), [Entry { key: "key", value: "value" }]);
    }

    #[test]
    fn names_the_place_of_the_cut() {
        let file = [vec![0x08, 0x08], field(7, &field(2, b"a long name"))].concat();
        let cut = &file[..file.len() - 3];
        assert_eq!(metadata(cut), Err(Error::Truncated { offset: 2, missing: 3 }));
        assert!(matches!(metadata(&[]), Err(Error::NotOnnx { .. })));
    }

    #[test]
    fn refuses_what_is_not_utf8_and_names_its_key() {
        let entry = [field(1, b"taut.grid"), field(2, b"3\xff")].concat();
        match metadata(&field(14, &entry)) {
            Err(Error::Metadata { key, reason }) => {
                assert_eq!(key, "taut.grid");
                assert!(reason.contains("UTF-8"), "{reason}");
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn refuses_a_crowd_of_empty_records() {
        // one million empty nodes in 2 MB
        let nodes = [0x0a, 0x00].repeat(1 << 20);
        let mut file = vec![7 << 3 | 2];
        let mut length = nodes.len();
        while length >= 0x80 {
            file.push((length & 0x7f) as u8 | 0x80);
            length >>= 7;
        }
        file.push(length as u8);
        file.extend(nodes);
        assert!(matches!(metadata(&file), Err(Error::NotOnnx { .. })));
    }

    #[test]
    fn refuses_other_files() {
        for file in [&b"\x89PNG\r\n\x1a\n"[..], b"#!/bin/sh\n", &[0xff; 40], &[0; 40]] {
            assert!(metadata(file).is_err());
        }
    }
}
