//! Bytes on disk: whole files, `.npy` arrays, LAZ and PCD point clouds, images and `.label` files.

pub(crate) mod files;
pub(crate) mod images;
pub(crate) mod label_file;
pub(crate) mod laz;
pub(crate) mod npy;
pub(crate) mod number;
pub(crate) mod pcd;
