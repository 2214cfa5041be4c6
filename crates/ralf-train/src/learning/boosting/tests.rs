use super::*;

/// Rows of features in [-1, 1), some absent, with a target that follows the first two.
fn table(rows: usize, width: usize, seed: u64) -> (Rows, Vec<bool>) {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut table = Rows::absent(rows, width);
    let mut target = Vec::new();
    for row in 0..rows {
        for value in table.row_mut(row) {
            *value = if random.random_bool(0.1) { f32::NAN } else { random.random_range(-1.0..1.0) };
        }
        let [a, b] = [0, 1].map(|feature| table.row(row)[feature]);
        let a = if a.is_nan() { 0.8 } else { a };
        let b = if b.is_nan() { 0.0 } else { b };
        target.push(random.random_bool(f64::from(0.1 + 0.8 * f32::from(u8::from(a + b * b > 0.3)))));
    }
    (table, target)
}

fn small() -> Parameters {
    Parameters { rounds: 60, rows_per_leaf: 20, feature_fraction: 1.0, ..Parameters::default() }
}

fn grown(rows: &Rows, target: &[bool], monotone: &[i8], parameters: &Parameters) -> Grown {
    let (bins, weights) = (Bins::new(rows), vec![1.0; rows.len()]);
    let (bins, weights) = (&bins, &weights);
    let examples = Examples { rows, bins, target, weights, monotone, begin: None };
    boost(&examples, &Vec::from_iter(0..rows.len() as u32), parameters)
}

#[test]
fn what_follows_from_features_is_learned_and_what_does_not_is_not_asked_for() {
    let (rows, target) = table(4000, 6, 1);
    let Grown { forest, gains } = grown(&rows, &target, &[0; 6], &small());
    let (unseen, truth) = table(2000, 6, 2);
    let right =
        forest.log_odds(&unseen).into_iter().zip(&truth).filter(|(score, truth)| (*score > 0.0) == **truth);
    // Nine in ten follow the rule.
    assert!(right.count() > 1700);
    assert!(gains[0] > 5.0 * gains[2..].iter().copied().fold(0.0, f64::max), "{gains:?}");
}

#[test]
fn one_question_is_the_best_there_is() {
    let (rows, target) = table(300, 3, 5);
    let parameters =
        Parameters { rounds: 1, leaves: 2, bagging: 1.1, rows_per_leaf: 10, rate: 1.0, ..small() };
    let Grown { forest, gains } = grown(&rows, &target, &[0; 3], &parameters);
    // Every threshold and both ways of absence, tried on the rows themselves.
    let loss = |yes: &dyn Fn(usize) -> bool| {
        let mut drop = 0.0;
        for side in [true, false] {
            let part: Vec<usize> = (0..rows.len()).filter(|row| yes(*row) == side).collect();
            if part.len() < 10 {
                return 0.0;
            }
            let (mut g, mut h) = (0.0, 0.0);
            for row in part {
                let (gradient, hessian) = derivatives(forest.base, target[row]);
                (g, h) = (g + gradient, h + hessian);
            }
            drop += g * g / (h + parameters.l2);
        }
        drop
    };
    let whole = {
        let sums = target.iter().map(|target| derivatives(forest.base, *target));
        let (g, h) = sums.fold((0.0, 0.0), |(g, h), (gradient, hessian)| (g + gradient, h + hessian));
        g * g / (h + parameters.l2)
    };
    let mut best = 0.0_f64;
    for feature in 0..3 {
        for edge in Bins::new(&rows).edges(feature) {
            for absent_is_yes in [true, false] {
                let yes = |row: usize| {
                    let value = rows.row(row)[feature];
                    if value.is_nan() { absent_is_yes } else { value <= *edge }
                };
                best = best.max(loss(&yes) - whole);
            }
        }
    }
    let found: f64 = gains.iter().sum();
    assert!((found - best).abs() < 1e-4 * best, "{found} and {best}");
}

#[test]
fn a_monotone_feature_never_turns_round() {
    let (rows, target) = table(3000, 4, 3);
    for direction in [1_i8, -1] {
        let monotone = [direction, direction, 0, 0];
        let Grown { forest, .. } = grown(&rows, &target, &monotone, &small());
        let (probes, _) = table(50, 4, 4);
        for probe in 0..probes.len() {
            for feature in 0..2 {
                let mut line = Rows::absent(41, 4);
                for step in 0..line.len() {
                    line.row_mut(step).copy_from_slice(probes.row(probe));
                    line.row_mut(step)[feature] = step as f32 / 20.0 - 1.0;
                }
                let answers = forest.log_odds(&line);
                let turns = answers.windows(2).any(|pair| f64::from(direction) * (pair[1] - pair[0]) < -1e-6);
                assert!(!turns, "{direction} feature {feature}: {answers:?}");
            }
        }
    }
}

#[test]
fn rows_that_are_not_trained_on_change_nothing_and_a_seed_repeats_itself() {
    let (rows, target) = table(1000, 4, 6);
    let bins = Bins::new(&rows);
    let weights = vec![1.0; rows.len()];
    let examples = Examples {
        rows: &rows,
        bins: &bins,
        target: &target,
        weights: &weights,
        monotone: &[0; 4],
        begin: None,
    };
    let train: Vec<u32> = (0..600).collect();
    let parameters = Parameters { rounds: 20, ..small() };
    let first = boost(&examples, &train, &parameters);
    let flipped: Vec<bool> = target.iter().enumerate().map(|(row, target)| *target == (row < 600)).collect();
    assert_eq!(boost(&Examples { target: &flipped, ..examples }, &train, &parameters), {
        let kept: Vec<bool> = (0..1000).map(|row| flipped[row] && row < 600).collect();
        boost(&Examples { target: &kept, ..examples }, &train, &parameters)
    });
    assert_eq!(boost(&examples, &train, &parameters), first);
    assert_ne!(boost(&examples, &train, &Parameters { seed: 1, ..parameters }), first);
}

#[test]
fn rows_of_one_kind_or_none_give_a_forest_that_says_so() {
    let (rows, _) = table(100, 2, 7);
    let all = grown(&rows, &[true; 100], &[0; 2], &small());
    assert!(all.forest.log_odds(&rows).iter().all(|score| *score > 3.0));
    let (rows, target) = table(0, 2, 7);
    let none = grown(&rows, &target, &[0; 2], &small());
    assert_eq!(none.forest.base, 0.0);
}
