//! Whether the bytes of an `.onnx` file hang together, looked at before a runtime sees them: it takes each length at
//! its word and asks for as much memory.
//!
//! The file is a Protocol Buffers message of type `ModelProto` (onnx.proto), and messages lie in each other.

/// Messages may lie so deep in each other: a graph in an attribute of a node of a graph, and so on.
const DEEPEST: usize = 64;
/// More than any window, stride, dilation or margin of a convolution, px.
const WIDEST: i64 = 4096;
/// Attributes whose values say how large an image becomes.
const WIDTHS: [&[u8]; 5] = [b"pads", b"strides", b"dilations", b"kernel_shape", b"output_padding"];

/// The field of a tensor that says in which other file its numbers lie.
const EXTERNAL: u64 = 13;
/// What is said of such a network: what lies in another file is not known by its hash, and is looked for in whatever
/// folder the program was started in.
const ELSEWHERE: &str = "weights: expected them in the file itself, found some in another one beside it: export the \
                         network in one file (torch.onnx.export: external_data=False)";

/// Messages of onnx.proto that hold others, or what is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Message {
    Model,
    Graph,
    Node,
    Attribute,
    Value,
    Type,
    Tensor,
    Shape,
    Sizes,
    /// One of strings, numbers and bytes alone.
    Plain,
}

impl Message {
    /// For people.
    fn words(self) -> &'static str {
        match self {
            Self::Model => "the network",
            Self::Graph => "a graph",
            Self::Node => "a node",
            Self::Attribute => "an attribute of a node",
            Self::Value => "an input or output",
            Self::Type => "a type",
            Self::Tensor => "a tensor",
            Self::Shape | Self::Sizes => "a shape",
            Self::Plain => "a text or a list of numbers",
        }
    }

    /// The message in a field, where there is one.
    fn field(self, number: u64) -> Option<Self> {
        use Message::{Attribute, Graph, Model, Node, Plain, Shape, Sizes, Tensor, Type, Value};
        Some(match (self, number) {
            (Model, 7) | (Attribute, 6 | 11) => Graph,
            (Graph, 1) => Node,
            (Graph, 5) | (Attribute, 5 | 10) => Tensor,
            (Graph, 11..=13) => Value,
            (Node, 5) => Attribute,
            (Value, 2) | (Attribute, 14 | 15) => Type,
            (Type, 1) => Shape,
            (Shape, 2) => Sizes,
            // Which operators it is of, and words about it: a domain, a key.
            (Model, 8 | 14) | (Sizes, 1) => Plain,
            _ => return None,
        })
    }
}

/// A field of a message.
struct Field<'a> {
    number: u64,
    /// Its bytes, where it has a length.
    content: Option<&'a [u8]>,
    /// Its number, where it is one.
    value: u64,
}

/// Refuses bytes whose lengths lead beyond their message; the error says where.
pub(crate) fn check(bytes: &[u8]) -> Result<(), String> {
    message(bytes, Message::Model, 0)
}

fn message(mut bytes: &[u8], kind: Message, depth: usize) -> Result<(), String> {
    if depth > DEEPEST {
        return Err(format!("messages lie more than {DEEPEST} deep in each other"));
    }
    let mut widths: Vec<u64> = Vec::new();
    let mut name: &[u8] = &[];
    while !bytes.is_empty() {
        let (field, rest) = next(bytes).ok_or_else(|| format!("{} is cut short or damaged", kind.words()))?;
        if (kind, field.number) == (Message::Tensor, EXTERNAL) {
            return Err(ELSEWHERE.to_owned());
        }
        if let Some((content, inner)) = field.content.zip(kind.field(field.number)) {
            message(content, inner, depth + 1)?;
        }
        match (kind, field.number, field.content) {
            (Message::Attribute, 1, Some(content)) => name = content,
            (Message::Attribute, 8, Some(packed)) => widths.extend(numbers(packed)),
            (Message::Attribute, 8, None) => widths.push(field.value),
            _ => {}
        }
        bytes = rest;
    }
    match widths.iter().find(|value| !(-WIDEST..=WIDEST).contains(&value.cast_signed())) {
        Some(value) if WIDTHS.contains(&name) => {
            let name = String::from_utf8_lossy(name);
            Err(format!("{name}: expected at most {WIDEST}, found {}", value.cast_signed()))
        }
        _ => Ok(()),
    }
}

/// The field at the beginning, and what follows it; `None` where that leads beyond the end.
fn next(bytes: &[u8]) -> Option<(Field<'_>, &[u8])> {
    let (key, rest) = varint(bytes)?;
    let number = key >> 3;
    let plain = |value, rest| Some((Field { number, content: None, value }, rest));
    match key & 7 {
        0 => {
            let (value, rest) = varint(rest)?;
            plain(value, rest)
        }
        1 => plain(0, rest.get(8..)?),
        2 => {
            let (length, rest) = varint(rest)?;
            let (content, rest) = rest.split_at_checked(usize::try_from(length).ok()?)?;
            Some((Field { number, content: Some(content), value: 0 }, rest))
        }
        5 => plain(0, rest.get(4..)?),
        _ => None,
    }
}

/// The numbers of a packed list, as far as it is whole.
fn numbers(mut packed: &[u8]) -> Vec<u64> {
    let mut numbers = Vec::new();
    while let Some((value, rest)) = varint(packed) {
        numbers.push(value);
        packed = rest;
    }
    numbers
}

fn varint(bytes: &[u8]) -> Option<(u64, &[u8])> {
    let mut value = 0;
    for (place, byte) in bytes.iter().enumerate().take(10) {
        value |= u64::from(byte & 0x7f).checked_shl(7 * place as u32)?;
        if byte & 0x80 == 0 {
            return Some((value, &bytes[place + 1..]));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{FLOAT, channel_sum, conv, node, onnx, weights};

    #[test]
    fn whole_networks_pass() {
        assert_eq!(check(&channel_sum([0.5; 3])), Ok(()));
        assert_eq!(check(&[]), Ok(()));
    }

    #[test]
    fn whose_operators_it_has_and_what_its_authors_say_are_texts() {
        // Exporters name further operators, and say who made it: a domain and a version, a key and a value.
        let domain = [&[8 << 3 | 2, 14, 0x0a, 10], b"ai.onnx.ml".as_slice(), &[0x10, 2]].concat();
        let author = [&[14 << 3 | 2, 13, 0x0a, 6], b"author".as_slice(), &[0x12, 3], b"ada"].concat();
        let network = [channel_sum([0.5; 3]), domain, author].concat();
        assert_eq!(check(&network), Ok(()));
        assert!(check(&network[..network.len() - 1]).unwrap_err().contains("the network is cut short"));
    }

    #[test]
    fn a_length_beyond_its_message_is_refused_before_memory_is_asked_for() {
        let whole = channel_sum([0.5; 3]);
        // A string of 2^56 bytes: field 2 (the producer's name) with its length.
        let huge = [&[0x12, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x7f], whole.as_slice()].concat();
        assert!(check(&huge).unwrap_err().contains("the network is cut short"));
        for cut in 1..whole.len() {
            // What ends between two fields of the model is whole by itself.
            let _ = check(&whole[..cut]);
        }
        assert!(check(&whole[..whole.len() - 1]).is_err());
    }

    #[test]
    fn a_margin_wider_than_any_image_is_refused() {
        let network = |margin| {
            let (input, output) = (("image", FLOAT, &[1, 3, 0, 0][..]), ("depth", FLOAT, &[1, 1, 0, 0][..]));
            onnx(&[conv("depth", margin)], &[weights("w", &[1, 3, 1, 1], &[1.0; 3])], &[input], &[output])
        };
        assert_eq!(check(&network(4096)), Ok(()));
        assert_eq!(check(&network(1 << 40)).unwrap_err(), "pads: expected at most 4096, found 1099511627776");
        // Elsewhere such a number means `to the end`.
        let slice = node("Slice", &["image"], "depth", &[("ends", &[i64::MAX.cast_unsigned()])]);
        assert_eq!(check(&onnx(&[slice], &[], &[], &[])), Ok(()));
    }

    #[test]
    fn weights_in_another_file_are_refused() {
        let here = weights("w", &[1, 3, 1, 1], &[1.0; 3]);
        // A text of a key and its value: location, net.onnx.data.
        let entry = [&[0x0a, 8], b"location".as_slice(), &[0x12, 13], b"net.onnx.data"].concat();
        let elsewhere = [here.clone(), vec![13 << 3 | 2, entry.len() as u8], entry].concat();
        let network = |weights| onnx(&[conv("depth", 0)], &[weights], &[], &[]);
        assert_eq!(check(&network(here)), Ok(()));
        assert!(check(&network(elsewhere)).unwrap_err().contains("external_data=False"));
    }

    #[test]
    fn graphs_that_lie_too_deep_in_each_other_are_refused() {
        let wrap = |field: u8, content: Vec<u8>| {
            let mut length = Vec::new();
            let mut rest = content.len();
            while rest >= 0x80 {
                length.push(rest as u8 | 0x80);
                rest >>= 7;
            }
            length.push(rest as u8);
            [vec![field << 3 | 2], length, content].concat()
        };
        let deep = (0..100).fold(Vec::new(), |graph, _| wrap(1, wrap(5, wrap(6, graph))));
        assert!(check(&wrap(7, deep)).unwrap_err().contains("more than 64 deep"));
    }
}
