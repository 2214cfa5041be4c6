//! How the LiDARs see the place of a detection.

use crate::evidence::Column;

/// How most of the LiDAR scans around see the place of a detection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Visibility {
    /// Rays pass through it, or reach the ground on which it would stand.
    FreeSpace,
    /// Rays end in it.
    OnSurface,
    /// Rays end before it.
    Occluded,
    /// No ray goes there, or there is no LiDAR.
    NotLookedAt,
}

/// The share of the scans that see a place so, by column; of equal shares the first counts.
const SHARES: [(&str, Visibility); 4] = [
    ("lidar_surface", Visibility::OnSurface),
    ("lidar_free", Visibility::FreeSpace),
    ("lidar_occluded", Visibility::Occluded),
    ("lidar_unseen", Visibility::NotLookedAt),
];

impl Visibility {
    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::FreeSpace => "free space",
            Self::OnSurface => "on a surface",
            Self::Occluded => "occluded",
            Self::NotLookedAt => "not looked at",
        }
    }

    /// Of each of so many detections, by the evidence of their scan.
    pub fn of_scan(evidence: &[Column], detections: usize) -> Vec<Self> {
        let mut most = vec![(0.0, Self::NotLookedAt); detections];
        for (name, visibility) in SHARES {
            let Some(column) = evidence.iter().find(|column| column.feature.name == name) else { continue };
            for (most, share) in most.iter_mut().zip(&column.values) {
                let share = share.unwrap_or(0.0);
                if share > most.0 {
                    *most = (share, visibility);
                }
            }
        }
        most.into_iter().map(|(_, visibility)| visibility).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::features;

    #[test]
    fn what_most_scans_see_counts_and_nothing_seen_is_not_looked_at() {
        let column = |name: &str, values: [f64; 4]| Column {
            feature: features().find(|feature| feature.name == name).unwrap(),
            values: values.map(|value| (value >= 0.0).then_some(value)).to_vec(),
        };
        let evidence = [
            column("lidar_free", [0.5, 0.1, 0.0, -1.0]),
            column("lidar_surface", [0.5, 0.2, 0.0, -1.0]),
            column("lidar_occluded", [0.0, 0.7, 0.0, -1.0]),
            column("lidar_unseen", [0.0, 0.0, 1.0, -1.0]),
        ];
        let found = Visibility::of_scan(&evidence, 4).into_iter().map(Visibility::name);
        assert!(found.eq(["on a surface", "occluded", "not looked at", "not looked at"]));
        assert_eq!(Visibility::of_scan(&[], 1), [Visibility::NotLookedAt], "no LiDAR");
    }

    #[test]
    fn every_share_is_a_feature() {
        assert!(SHARES.iter().all(|(name, _)| features().any(|feature| feature.name == *name)));
    }
}
