//! What the options are said to take that lead to what networks said of images: it names commands that not every build
//! has.

/// `--depth`.
pub(crate) const STORED_DEPTH: &str = match cfg!(feature = "depth") {
    true => "Take depth images from this folder, as `ralf depth -o` wrote them",
    false => "Take depth images from this folder, as a build of ralf with the feature `depth` wrote them",
};

/// `--segmentation`.
pub(crate) const STORED_CLASSES: &str = match cfg!(feature = "depth") {
    true => {
        "Take segmentations from this folder, as `ralf segment -o` wrote them: they tell classes (column class_from)"
    }
    false => {
        "Take segmentations from this folder, as a build of ralf with the feature `depth` wrote them: they tell \
         classes (column class_from)"
    }
};
