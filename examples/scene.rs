//! A scene with a known answer for an engine that simulates contacts.
//!
//!     cargo run --release --features scene --example scene -- [scene.json]
//!
//! A tube is dropped onto a table with dry friction, from which it bounces. The scene has its start, and its place,
//! orientation, velocities, contact point and force at 401 times in one second. If a file is named, the scene is
//! written to it, and the model for MuJoCo to a file in the same folder.

use spincyl::contact::Friction;
use spincyl::measured::{Measured, Tube};
use spincyl::motion::{AboveTable, Ask, Start};
use spincyl::scene::{Scene, SceneError};
use spincyl::{Slip, State};

/// The scene of a thrown tube with its computed motion.
///
/// # Errors
/// None, since all numbers of the scene are in range.
pub fn thrown() -> Result<Scene, SceneError> {
    let tube = Tube::solid(15.875e-3, 95.25e-3, 20e-3).with_inner_diameter(12.7e-3);
    let pipe = Measured::tube(&tube)?;
    let scale = pipe.scale();
    // It leans by 80 degrees, turns by 20 rad/s about the vertical and by 30 about its axis, 5 mm above the table.
    let [precession, spin] = [20.0, 30.0].map(|w| scale.angular_velocity(w));
    let state = State::from_rates(80f64.to_radians(), 0.0, precession, spin);
    let start = Start::from(state)
        .with_slip(Slip::new(0.0, scale.speed(0.2)))
        .with_aloft(AboveTable::new(scale.length(5e-3), 0.0));
    let seconds: Vec<f64> = (0..=400).map(|i| 0.0025 * f64::from(i)).collect();
    let ask = Ask::on(Friction::coulomb(0.3)).with_restitution(0.5);
    Scene::of(&pipe, start, &seconds, &ask)
}

#[allow(dead_code)] // The tests use the rest.
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = thrown()?;
    match std::env::args().nth(1) {
        Some(path) => {
            std::fs::write(&path, scene.json())?;
            std::fs::write(std::path::Path::new(&path).with_extension("xml"), scene.mjcf())?;
        }
        None => println!("{}", scene.json()),
    }
    let known = scene.contents();
    eprintln!("{} times, error of the place {:.0e} m", known.expected.time.len(), known.error.position);
    Ok(())
}
