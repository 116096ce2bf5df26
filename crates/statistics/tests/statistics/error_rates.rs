//! Rates against promises.

use etalon_statistics::error_rates::{Rate, alarms, coverage, decades, histogram};
use etalon_statistics::{Interval, proportion};

#[test]
fn alarms_by_decades() {
    // Ten thousand p-values as even as can be: (i + ½)/10⁴.
    let even: Vec<f64> = (0..10_000).map(|i| (f64::from(i) + 0.5) / 1e4).collect();
    let rates = decades(&even, 1e-5, 0.999).expect("p-values");
    let counts: Vec<u64> = rates.iter().map(|rate| rate.count).collect();
    assert_eq!(counts, [5000, 1000, 100, 10, 1, 0]);
    assert_eq!(rates[5].promised, 1e-5);
    assert!(rates.iter().all(Rate::is_kept));
    assert_eq!(rates[2].observed(), 0.01);
    assert_eq!(
        rates[2].interval,
        proportion::interval(100, 10_000, 0.999).expect("trials")
    );
    // Mutant: every p-value halved alarms twice as often; every one doubled half as often, which a
    // cautious test may.
    let halved: Vec<f64> = even.iter().map(|p| 0.5 * p).collect();
    let bad = alarms(&halved, 0.01, 0.999).expect("p-values");
    assert!(!bad.is_kept() && !bad.is_not_exceeded());
    let doubled: Vec<f64> = even.iter().map(|p| (2.0 * p).min(1.0)).collect();
    let cautious = alarms(&doubled, 0.01, 0.999).expect("p-values");
    assert!(!cautious.is_kept() && cautious.is_not_exceeded());
    assert_eq!(alarms(&[], 0.01, 0.9), None);
    assert_eq!(alarms(&[0.5, f64::NAN], 0.01, 0.9), None);
}

#[test]
fn coverages_and_histograms() {
    let intervals = (0..100).map(|i| {
        let low = f64::from(i) / 100.0;
        Interval {
            low,
            high: low + 0.5,
        }
    });
    // Those from 0.20 to 0.70 hold 0.7: fifty-one.
    let rate = coverage(intervals, 0.7, 0.5, 0.99).expect("trials");
    assert_eq!((rate.count, rate.trials), (51, 100));
    assert!(rate.is_kept());
    assert_eq!(coverage([], 0.7, 0.5, 0.99), None);

    assert_eq!(
        histogram(&[0.0, 0.1, 0.5, 0.99, 1.0], 4),
        Some(vec![2, 0, 1, 2])
    );
    assert_eq!(histogram(&[0.5], 0), None);
    assert_eq!(histogram(&[1.5], 4), None);
}
