//! Bytes on disk: whole files, `.npy` arrays, images and `.label` files.

pub(crate) mod files;
pub(crate) mod images;
pub(crate) mod label_file;
pub(crate) mod npy;
