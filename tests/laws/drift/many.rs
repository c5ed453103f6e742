//! Many drifts at once: they are those of single drifts, and no bit depends on threads or neighbours.

use super::apart;
use crate::common;
use crate::common::many::{LAWS, loss_columns};
use spincyl::drift::{BodyColumns, Centre, DriftAnswer, DriftOutput, DriftStarts, INVALID, Question};
use spincyl::{Body, State, steady};

/// Columns of random starts; one in fifty has a negative coefficient.
struct Many {
    centre: Centre,
    bodies: [Vec<f64>; 6],
    states: [Vec<f64>; 4],
    losses: [Vec<f64>; LAWS],
}

impl Many {
    fn random(centre: Centre, count: usize, seed: u64) -> Self {
        let mut r = common::wander(seed);
        let mut all = Self {
            centre,
            bodies: Default::default(),
            states: Default::default(),
            losses: Default::default(),
        };
        for _ in 0..count {
            let fillet = if r() < 0.5 { 0.0 } else { 0.3 * r() };
            // One in four is a coin or next to one.
            let half = fillet + 3.0 * r() * r() * [1.0, 1.0, 1e-3 * r(), 0.0][(4.2 * r()) as usize % 4];
            let body = Body::rounded_tube(half, 0.0, fillet).unwrap();
            let theta = 1.57 * r();
            let y = steady::state(&body, theta).unwrap_or(State { theta, w1: 1.0, w2: 0.0, w3: 0.0 });
            let y = if r() < 0.5 {
                y
            } else {
                // Half of the circular states are far from those whose centre rests.
                let rate =
                    if r() < 0.5 { y.precession() * (0.9 + 0.2 * r()) } else { (4.0 * r() - 1.5).exp() };
                steady::circular(&body, theta, rate).unwrap_or(y)
            };
            let numbers = [body.ell(), body.i1(), body.i3(), 0.0, fillet, f64::NAN];
            for (column, x) in all.bodies.iter_mut().zip(numbers) {
                column.push(x);
            }
            for (column, x) in all.states.iter_mut().zip(common::numbers(&y)) {
                column.push(x);
            }
            let first = (LAWS as f64 * r()) as usize;
            let second = (LAWS as f64 * r()) as usize;
            for (i, column) in all.losses.iter_mut().enumerate() {
                let here = i == first || (i == second && second > 3);
                column.push(if here { 10f64.powf(-5.0 * r()) } else { 0.0 });
            }
            if r() < 0.02 {
                all.losses[first].pop();
                all.losses[first].push(-1.0);
            }
        }
        all
    }

    fn starts(&self) -> DriftStarts<'_> {
        let Self { centre, bodies, states, losses } = self;
        let [ell, i1, i3, bore, fillet, theta_end] = core::array::from_fn(|i| bodies[i].as_slice());
        let columns = BodyColumns::new(ell, i1, i3).with_bore(bore).with_fillet(fillet);
        let states = core::array::from_fn(|i| states[i].as_slice());
        DriftStarts::new(*centre, columns.with_theta_end(theta_end), states, loss_columns(losses))
    }

    /// The part of the columns with every `step`th start from `from` on.
    fn part(&self, from: usize, step: usize) -> Self {
        let cut = |x: &Vec<f64>| x.iter().skip(from).step_by(step).copied().collect::<Vec<_>>();
        Self {
            centre: self.centre,
            bodies: self.bodies.each_ref().map(cut),
            states: self.states.each_ref().map(cut),
            losses: self.losses.each_ref().map(cut),
        }
    }
}

/// The times, the inclinations and the codes of the ends of all drifts.
fn stopped(many: &Many, threads: usize) -> (Vec<f64>, Vec<f64>, Vec<u8>) {
    let n = many.states[0].len();
    let (mut times, mut thetas, mut ends) = (vec![0.0; n], vec![0.0; n], vec![0; n]);
    let out = DriftOutput::new(&mut times, &mut thetas, &mut ends);
    assert!(spincyl::drift::stops(&many.starts(), out, threads, |_| true).unwrap());
    (times, thetas, ends)
}

#[test]
fn many_drifts_are_those_of_each_alone() {
    for (centre, bound) in [(Centre::Rest, 1e-12), (Centre::Rolling, 1e-10)] {
        let many = Many::random(centre, 700, 7);
        let (times, thetas, ends) = stopped(&many, 2);
        let (mut worst, mut drifts) = (0f64, 0);
        for i in 0..times.len() {
            match spincyl::drift::single(&many.starts(), i) {
                Ok(d) => {
                    drifts += 1;
                    assert_eq!(
                        ends[i],
                        d.ended() as u8,
                        "{centre:?} {i}: {:?} {:?} {:?} {:?}",
                        d.ended(),
                        many.bodies.each_ref().map(|x| x[i]),
                        many.states[0][i],
                        many.losses.each_ref().map(|x| x[i])
                    );
                    assert!((thetas[i] - d.ends_at_theta()).abs() < 1e-7);
                    if d.stops_at() == 0.0 || d.stops_at().is_infinite() {
                        assert_eq!(times[i], d.stops_at());
                    } else {
                        worst = worst.max(apart(times[i], d.stops_at()));
                        assert!(
                            apart(times[i], d.stops_at()) < bound,
                            "{centre:?} {i}: {} {} {:?}",
                            times[i],
                            d.stops_at(),
                            d.ended()
                        );
                    }
                }
                Err(_) => assert!(times[i].is_nan() && ends[i] == INVALID),
            }
        }
        println!("{centre:?}: {drifts} drifts, {worst:e}");
        assert!(drifts > 200);
    }
}

#[test]
fn neighbours_and_threads_do_not_change_a_bit() {
    for centre in [Centre::Rest, Centre::Rolling] {
        let many = Many::random(centre, if centre == Centre::Rest { 1500 } else { 200 }, 11);
        let whole = stopped(&many, 1);
        let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        let again = stopped(&many, 3);
        assert_eq!((bits(&whole.0), bits(&whole.1), &whole.2), (bits(&again.0), bits(&again.1), &again.2));
        for (from, step) in [(1, 7), (3, 2), (11, 501)] {
            let part = stopped(&many.part(from, step), 1);
            let same: Vec<f64> = whole.0.iter().skip(from).step_by(step).copied().collect();
            assert_eq!(bits(&part.0), bits(&same));
        }
    }
}

#[test]
fn nobody_and_one_for_all_are_answered_and_who_says_no_is_heard() {
    let none = Many::random(Centre::Rest, 0, 1);
    assert!(stopped(&none, 2).0.is_empty());
    let mut many = Many::random(Centre::Rest, 40_000, 3);
    for column in many.bodies.iter_mut().chain(&mut many.losses) {
        column.truncate(1);
    }
    assert_eq!(stopped(&many, 2).0.len(), 40_000);
    let n = many.states[0].len();
    let (mut times, mut thetas, mut ends) = (vec![0.0; n], vec![0.0; n], vec![0; n]);
    let out = DriftOutput::new(&mut times, &mut thetas, &mut ends);
    let mut asked = 0;
    let finished = spincyl::drift::stops(&many.starts(), out, 1, |_| {
        asked += 1;
        false
    });
    assert!(finished.unwrap() == (asked == 0));
}

#[test]
fn what_many_are_asked_is_what_one_answers() {
    for centre in [Centre::Rest, Centre::Rolling] {
        let many = Many::random(centre, 20, 5);
        let of: Vec<usize> = (0..60).map(|i| i / 3).collect();
        let x: Vec<f64> = (0..60).map(|i| 0.01 * (i % 3) as f64).collect();
        for question in [Question::Time, Question::At, Question::Stable] {
            let mut out = vec![DriftAnswer::NONE; 60];
            assert!(spincyl::drift::ask(&many.starts(), question, (&of, &x), &mut out, 2, |_| true).unwrap());
            for i in 0..60 {
                let one = spincyl::drift::single(&many.starts(), of[i]).ok();
                let expected = one.map_or(f64::NAN, |d| match question {
                    Question::Time => d.time(x[i]),
                    Question::At => d.theta(x[i]),
                    _ => d.stable_until(),
                });
                let found = if question == Question::At { out[i].theta } else { out[i].time };
                assert_eq!(found.to_bits(), expected.to_bits());
            }
        }
    }
}
