//! The estimated errors of motions of stones.

use crate::common::{cases, larger};
use crate::stone::{TIMES, any_start, any_stone, apart};
use proptest::prelude::*;
use spincyl::contact::{Friction, Table};
use spincyl::motion::{Ask, Method};
use spincyl::stone::{self, Ellipsoid, StoneState};

/// A case: a stone, its start, a coefficient of friction, whether it slips, and log10 of a tolerance.
type Asked = (Ellipsoid, StoneState, f64, bool, f64);

/// The largest difference between a motion and one with the given tolerance, over the sum of their estimated errors.
fn beyond_claims(&(ref stone, start, mu, slips, tol): &Asked) -> f64 {
    let table = if slips { Friction::coulomb(mu).into() } else { Table::default() };
    let ask = Ask::default().with_table(table);
    let rough = ask.with_method(Method::Tolerance(10f64.powf(tol)));
    let roll = |ask| stone::roll(stone, start, &TIMES, ask, || true);
    let (Ok(Some(a)), Ok(Some(b))) = (roll(&ask), roll(&rough)) else { return 0.0 };
    let states = a.states.iter().zip(&b.states).map(|(x, y)| apart(x, y));
    let events = a.event.iter().zip(&b.event).map(|(x, y)| (x.time - y.time).abs());
    states.chain(events).fold(0.0, larger) / (a.error + b.error)
}

proptest! {
    #![proptest_config(ProptestConfig { max_shrink_iters: 0, ..cases(4) })]

    /// The error is estimated from two runs: of 15,000 random stones 13 had a larger error, by a factor of at most
    /// 4.7.
    #[test]
    fn the_claimed_errors_of_stones_are_honest(
        asked in prop::collection::vec(
            (any_stone(), any_start(), 0.05..0.6f64, any::<bool>(), -12.0..-5.0f64), 64,
        ),
    ) {
        let ratios: Vec<f64> = asked.iter().map(beyond_claims).collect();
        let beyond = ratios.iter().filter(|&&ratio| ratio > 1.0).count();
        let worst = ratios.iter().fold(0.0f64, |a, &b| a.max(b));
        prop_assert!(beyond <= 3 && worst < 100.0, "{beyond} of {} beyond, the worst {worst} times", ratios.len());
    }
}

#[test]
fn a_stone_drawn_once_lies_next_to_its_claim() {
    // The difference was 3 % larger than the claim.
    let inertia = [
        [0.11281683048048702, -0.043712480719867504, -0.009848165769554098],
        [-0.043712480719867504, 0.19929025216232527, 0.023592801082846535],
        [-0.009848165769554098, 0.023592801082846535, 0.19568706041051093],
    ];
    let offset = [0.012230299159020332, -0.10752356780026649, -0.023579460753424875];
    let axes = [0.22308018536793364, 0.8940394178753182, 1.0];
    let stone = Ellipsoid::new(axes, inertia, offset).unwrap();
    let start = StoneState {
        vertical: [-0.02115714138386723, -0.6235163189451837, -0.7815240081900945],
        w: [1.0205395708654577, 0.0, -0.9775257983419945],
    };
    let ratio = beyond_claims(&(stone, start, 0.13149274267175984, true, -7.556916067120013));
    assert!((0.01..1.5).contains(&ratio), "{ratio}");
}

#[test]
fn rough_motions_of_stones_end_where_fine_ones_do() {
    // Found by random tests: within a step static friction failed and, since forces enter squared, seemed to
    // hold again at a negative N; or N fell below zero and rose again.
    let drawn = [
        (
            [0.9872981515532196, 0.5284546301266001, 1.0],
            [
                [0.11244611958362612, 0.02630831725354086, -0.02699712217668261],
                [0.02630831725354086, 0.09913184212706785, 0.034679472357019875],
                [-0.02699712217668261, 0.034679472357019875, 0.16149450579125285],
            ],
            [-0.06720623191451097, 0.07595627195331706, 0.11302878091359203],
            [-0.16754671122461737, -0.140162901574678, -0.9758496096120456],
            [-0.8808448826539765, -1.3960678945380502, -0.9638091053512923],
            Some(0.2729357340953509),
        ),
        (
            [0.583685447277908, 1.0, 0.5251690269695489],
            [
                [0.37000334549419117, -0.1406539599601692, 0.10791986164964155],
                [-0.1406539599601692, 0.28197352867767755, 0.14685193550370781],
                [0.10791986164964155, 0.14685193550370781, 0.4517968986839207],
            ],
            [-0.0011373692569859287, -0.09267995735747081, 0.007153757086689407],
            [-0.1385347375166632, 0.4624982795891503, 0.8757302483517772],
            [1.3779073852601786, 1.1436968848473867, 1.2691371333098989],
            None,
        ),
    ];
    for (axes, inertia, offset, vertical, w, mu) in drawn {
        let stone = Ellipsoid::new(axes, inertia, offset).unwrap();
        let table = mu.map_or(Table::default(), |mu| Friction::coulomb(mu).into());
        let end = |method| {
            let ask = Ask::default().with_table(table).with_method(method);
            stone::roll(&stone, StoneState { vertical, w }, &TIMES, &ask, || true).unwrap().unwrap()
        };
        let fine = end(Method::Exact).event.unwrap();
        for tol in [-8.0, -7.0, -6.0, -5.5, -5.0] {
            let rough = end(Method::Tolerance(10f64.powf(tol)));
            let event = rough.event.unwrap();
            assert!(
                event.ending == fine.ending && (event.time - fine.time).abs() < rough.error,
                "{tol}: {event:?}"
            );
            assert!(rough.error < 1e3 * 10f64.powf(tol), "{tol}: {:e}", rough.error);
        }
    }
}
