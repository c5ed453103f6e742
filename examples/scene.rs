//! A scene with a known answer for an engine that simulates contacts, as JSON: what `spincyl.scene` writes in Python,
//! without the mesh and with fewer words.
//!
//!     cargo run --release --features serde --example scene -- [scene.json]
//!
//! A tube is dropped onto a table with dry friction, which it strikes and leaves; its start, its place,
//! orientation, velocities, contact point and force at 401 times of a second.

use serde_json::{Value, json};
use spincyl::contact::Friction;
use spincyl::measured::{Measured, MeasuredMotion, Reading, Tube};
use spincyl::motion::{Ask, Start};
use spincyl::{Error, State};

/// A column of the answer, one entry for each reading.
fn column<T: Into<Value>>(all: &[Reading], of: impl Fn(&Reading) -> T) -> Value {
    all.iter().map(|now| of(now).into()).collect()
}

/// The scene of a motion of a tube on a table with dry friction `mu`.
pub fn scene(tube: &Tube, mu: f64, restitution: f64, motion: &MeasuredMotion) -> Value {
    let all: Vec<Reading> = motion.readings().collect();
    let (body, scale, first) = (motion.of.body(), motion.of.scale(), all[0]);
    let [i1, i3] = [body.i1(), body.i3()].map(|moment| scale.kilogram_square_metres(moment));
    let (half, rim) = (0.5 * tube.length, 0.5 * tube.outer_diameter - tube.fillet);
    let circles = [-1.0, 1.0].map(|end| json!({"height": end * (half - tube.fillet), "radius": rim}));
    let bounds = motion.bounds();
    let path = motion.natural.path.as_deref();
    let impacts: Vec<Value> = path
        .into_iter()
        .flat_map(|path| &path.impacts)
        .map(|hit| {
            json!({
                "time": scale.seconds(hit.time),
                "kind": hit.hit.to_string(),
                "normal_impulse": scale.newton_seconds(hit.impulse[2]),
                "energy_lost": scale.joules(hit.lost),
            })
        })
        .collect();
    let phases: Vec<Value> = path
        .into_iter()
        .flat_map(|path| &path.phases)
        .map(|phase| json!({"time": scale.seconds(phase.time), "kind": phase.kind.to_string()}))
        .collect();
    let (ending, time) = motion.end();
    json!({
        "spincyl-scene": 1,
        "units": "SI: metres, kilograms, seconds, radians, newtons, joules",
        "axes": "of the laboratory, z up; quaternions are x, y, z, w and turn the body's axes into these",
        "gravity": [0.0, 0.0, -tube.gravity],
        "body": {
            "mass": tube.mass,
            "inertia": [[i1, 0.0, 0.0], [0.0, i1, 0.0], [0.0, 0.0, i3]],
            "shape": {
                "type": "cylinder",
                "radius": 0.5 * tube.outer_diameter,
                "inner_radius": 0.5 * tube.inner_diameter,
                "half_length": half,
                "swollen_by": tube.fillet,
                "circles": circles,
            },
        },
        "table": {
            "point": [0.0, 0.0, 0.0],
            "normal": [0.0, 0.0, 1.0],
            "friction": {"law": "coulomb", "mu": mu, "static": mu, "patch": 0.0},
            "restitution": restitution,
            "losses": [],
        },
        "start": {
            "position": first.position,
            "orientation": first.orientation,
            "velocity": first.velocity,
            "angular_velocity": first.angular_velocity,
            "angular_velocity_in_body_axes": first.orientation.inverse() * first.angular_velocity,
        },
        "expected": {
            "time": column(&all, |now| now.time),
            "position": column(&all, |now| json!(now.position)),
            "orientation": column(&all, |now| json!(now.orientation)),
            "velocity": column(&all, |now| json!(now.velocity)),
            "angular_velocity": column(&all, |now| json!(now.angular_velocity)),
            "theta": column(&all, |now| now.theta),
            "energy": column(&all, |now| now.energy),
            "contact_force": column(&all, |now| json!(now.force)),
            "contact_point": column(&all, |now| json!(now.contact_point)),
            "phases": phases,
            "impacts": impacts,
            "ending": {"kind": ending.to_string(), "time": time.or(all.last().map(|now| now.time))},
        },
        "error": {"position": bounds.position, "velocity": bounds.velocity, "angle": bounds.orientation,
            "angular_velocity": bounds.angular_velocity, "contact_force": bounds.force, "energy": bounds.energy},
    })
}

/// The scene of a tube that is thrown.
pub fn thrown() -> Result<(MeasuredMotion, Value), Error> {
    let tube = Tube::solid(15.875e-3, 95.25e-3, 20e-3).with_inner_diameter(12.7e-3);
    let (pipe, mu, restitution) = (Measured::tube(&tube)?, 0.3, 0.5);
    let scale = pipe.scale();
    // It leans by 80 degrees, turns by 20 rad/s about the vertical and by 30 about its axis, 5 mm above the table.
    let [precession, spin] = [20.0, 30.0].map(|w| scale.angular_velocity(w));
    let state = State::from_rates(80f64.to_radians(), 0.0, precession, spin);
    let start = Start::from(state).with_slip([0.0, scale.speed(0.2)]).with_aloft([scale.length(5e-3), 0.0]);
    let seconds: Vec<f64> = (0..=400).map(|i| 0.0025 * f64::from(i)).collect();
    let ask = Ask::on(Friction::coulomb(mu)).with_restitution(restitution);
    let motion = pipe.roll(start, &seconds, &ask, || true)?.expect("nobody interrupts");
    let told = scene(&tube, mu, restitution, &motion);
    Ok((motion, told))
}

#[allow(dead_code)] // The tests use the rest.
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (motion, told) = thrown()?;
    match std::env::args().nth(1) {
        Some(path) => std::fs::write(path, format!("{told}\n"))?,
        None => println!("{told}"),
    }
    eprintln!("{} times, error of the place {:.0e} m", motion.seconds.len(), motion.bounds().position);
    Ok(())
}
