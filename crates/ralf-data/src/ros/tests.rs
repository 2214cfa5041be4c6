//! On tiny recordings made by the tests themselves, and on real ones against the tables they were made from.
