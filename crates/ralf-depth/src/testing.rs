//! Tiny networks for tests, as the bytes of an `.onnx` file (a Protocol Buffers message, see onnx.proto).

/// Element types of ONNX.
pub(crate) const FLOAT: u64 = 1;
pub(crate) const INT64: u64 = 7;

/// An input or output: name, element type, sizes (0 for a free one).
pub(crate) type Value<'a> = (&'a str, u64, &'a [u64]);

/// A file with these nodes, weights (see [`weights`]), inputs and outputs.
pub(crate) fn onnx(
    nodes: &[Vec<u8>],
    weights: &[Vec<u8>],
    inputs: &[Value<'_>],
    outputs: &[Value<'_>],
) -> Vec<u8> {
    let graph = [
        nodes.iter().map(|node| bytes(1, node)).collect::<Vec<_>>().concat(),
        bytes(2, b"tiny"),
        weights.iter().map(|tensor| bytes(5, tensor)).collect::<Vec<_>>().concat(),
        inputs.iter().map(|value| bytes(11, &value_info(value))).collect::<Vec<_>>().concat(),
        outputs.iter().map(|value| bytes(12, &value_info(value))).collect::<Vec<_>>().concat(),
    ];
    let opset = [bytes(1, b""), number(2, 11)].concat();
    [number(1, 8), bytes(7, &graph.concat()), bytes(8, &opset)].concat()
}

/// An operator; attributes are lists of whole numbers.
pub(crate) fn node(operator: &str, inputs: &[&str], output: &str, attributes: &[(&str, &[u64])]) -> Vec<u8> {
    let attribute = |(name, values): &(&str, &[u64])| {
        let values: Vec<u8> = values.iter().flat_map(|value| number(8, *value)).collect();
        bytes(5, &[bytes(1, name.as_bytes()), values, number(20, 7)].concat())
    };
    [named(operator, inputs, output), attributes.iter().flat_map(attribute).collect()].concat()
}

fn named(operator: &str, inputs: &[&str], output: &str) -> Vec<u8> {
    let inputs: Vec<u8> = inputs.iter().flat_map(|name| bytes(1, name.as_bytes())).collect();
    [inputs, bytes(2, output.as_bytes()), bytes(3, output.as_bytes()), bytes(4, operator.as_bytes())].concat()
}

/// An operator of one input; attributes are whole numbers.
pub(crate) fn flagged(operator: &str, input: &str, output: &str, attributes: &[(&str, u64)]) -> Vec<u8> {
    let attribute = |(name, value): &(&str, u64)| {
        bytes(5, &[bytes(1, name.as_bytes()), number(3, *value), number(20, 2)].concat())
    };
    [named(operator, &[input], output), attributes.iter().flat_map(attribute).collect()].concat()
}

/// A convolution of `image` with the weights `w`, `margin` columns of zeros to either side.
pub(crate) fn conv(output: &str, margin: u64) -> Vec<u8> {
    // Their defaults, but rten asks for them.
    let unit: &[u64] = &[1, 1];
    let pads = ("pads", &[0, margin, 0, margin] as &[u64]);
    node("Conv", &["image", "w"], output, &[("strides", unit), ("dilations", unit), pads])
}

/// Constant floats.
pub(crate) fn weights(name: &str, shape: &[u64], values: &[f32]) -> Vec<u8> {
    let shape: Vec<u8> = shape.iter().flat_map(|size| number(1, *size)).collect();
    let raw: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    [shape, number(2, FLOAT), bytes(8, name.as_bytes()), bytes(9, &raw)].concat()
}

/// A network that sums the channels, each times its factor: float [1, 3, H, W] to [1, 1, H, W], of free sizes.
pub(crate) fn channel_sum(factors: [f32; 3]) -> Vec<u8> {
    onnx(
        &[conv("depth", 0)],
        &[weights("w", &[1, 3, 1, 1], &factors)],
        &[("image", FLOAT, &[1, 3, 0, 0])],
        &[("depth", FLOAT, &[1, 1, 0, 0])],
    )
}

fn value_info((name, element, sizes): &Value<'_>) -> Vec<u8> {
    let size = |(index, size): (usize, &u64)| match size {
        0 => bytes(1, &bytes(2, format!("free{index}").as_bytes())),
        _ => bytes(1, &number(1, *size)),
    };
    let shape: Vec<u8> = sizes.iter().enumerate().flat_map(size).collect();
    let tensor = [number(1, *element), bytes(2, &shape)].concat();
    [bytes(1, name.as_bytes()), bytes(2, &bytes(1, &tensor))].concat()
}

/// A field that holds a string, a message or packed bytes.
fn bytes(field: u64, content: &[u8]) -> Vec<u8> {
    [varint(field << 3 | 2), varint(content.len() as u64), content.to_vec()].concat()
}

/// A field that holds a whole number.
fn number(field: u64, value: u64) -> Vec<u8> {
    [varint(field << 3), varint(value)].concat()
}

fn varint(mut value: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
    bytes
}
