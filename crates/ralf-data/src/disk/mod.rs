//! Bytes on disk: whole files, `.npy` arrays, HDF5 and Parquet tables, LAZ and PCD clouds, images and `.label` files.

pub(crate) mod alone;
pub(crate) mod class_images;
pub(crate) mod edited;
pub(crate) mod files;
mod guarded;
pub(crate) mod hash;
pub(crate) mod hdf5;
pub(crate) mod images;
pub(crate) mod json;
pub(crate) mod label_file;
pub(crate) mod laz;
pub(crate) mod lzf;
pub(crate) mod npy;
pub(crate) mod number;
pub(crate) mod numbered;
pub(crate) mod parquet_table;
pub(crate) mod pcd;
pub(crate) mod real_path;
