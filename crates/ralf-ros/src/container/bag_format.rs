//! The bytes of ROS 1 bags, version 2.0: records of a header and data, both with their length before them.

/// What a bag begins with.
pub(crate) const MAGIC: &[u8] = b"#ROSBAG V2.0\n";

/// Kinds of records.
pub(crate) mod op {
    pub(crate) const MESSAGE: u8 = 2;
    pub(crate) const BAG_HEADER: u8 = 3;
    pub(crate) const INDEX: u8 = 4;
    pub(crate) const CHUNK: u8 = 5;
    pub(crate) const CHUNK_INFO: u8 = 6;
    pub(crate) const CONNECTION: u8 = 7;
}

/// Names with values, as headers and connections hold them: `length name=value` each.
#[derive(Debug, Clone, Default)]
pub(crate) struct Fields(Vec<u8>);

impl Fields {
    /// With one more.
    pub(crate) fn with(mut self, name: &str, value: &[u8]) -> Self {
        // Texts of definitions are the longest of them, of a few kB.
        let length = (name.len() + 1 + value.len()) as u32;
        self.0.extend(length.to_le_bytes());
        self.0.extend_from_slice(name.as_bytes());
        self.0.push(b'=');
        self.0.extend_from_slice(value);
        self
    }

    pub(crate) fn bytes(&self) -> &[u8] {
        &self.0
    }

    /// A record with these fields as its header.
    pub(crate) fn record(&self, data: &[u8]) -> Vec<u8> {
        let mut record = Vec::with_capacity(8 + self.0.len() + data.len());
        record.extend((self.0.len() as u32).to_le_bytes());
        record.extend_from_slice(&self.0);
        record.extend((data.len() as u32).to_le_bytes());
        record.extend_from_slice(data);
        record
    }
}
