//! The interface of the live page to the core: a call takes numbers, returns a code and fills a flat buffer.
//!
//! ```text
//! code = call(numbers)     new Float64Array(memory.buffer, out(), len())     made anew after every call
//! ```
//! No call takes a pointer, so that only the attribute that names an export is unsafe. Every refusal is a
//! code with a meaning ([`Refusal`]); every number is the result of a public function of `spincyl`. `exports`
//! names the calls of WebAssembly; as a Rust library the crate has [`Desk`], with which a native program
//! makes the same calls.
//!
//! `tests/test_web.py` compares the two: codes are equal, and motions agree within the error that they state.

mod body;
#[cfg(target_arch = "wasm32")]
mod exports;
mod hand;
mod map;
mod motion;
mod refusal;
mod steady;
#[cfg(feature = "friction")]
mod stone;
#[cfg(feature = "friction")]
mod walk;

use motion::Kept;
pub use refusal::Refusal;
use spincyl::Body;
use spincyl::loss::Losses;

/// The current body, its losses, its table and its motion, and the last answer.
#[derive(Debug, Default)]
pub struct Desk {
    /// The numbers of the last answer.
    pub out: Vec<f64>,
    /// The codes of the last map.
    pub codes: Vec<u8>,
    /// The name and the range of the number that was refused last, on two lines.
    pub words: String,
    body: Option<Body>,
    losses: Losses,
    /// The slope of the table, and the direction of the first lean from downhill.
    slope: [f64; 2],
    motion: Option<Kept>,
}

/// An answer, or the reason for its refusal.
pub type Answer = Result<(), Refusal>;

impl Desk {
    /// Clears the last answer, asks the question, and returns the code.
    pub fn ask(&mut self, question: impl FnOnce(&mut Self) -> Answer) -> u32 {
        self.out.clear();
        self.words.clear();
        match question(self) {
            Ok(()) => 0,
            Err(refusal) => {
                self.out.clear();
                refusal.tell(&mut self.out, &mut self.words)
            }
        }
    }

    fn set_body(&self) -> Result<Body, Refusal> {
        self.body.ok_or(Refusal::Nothing)
    }
}

/// A count that is given as a number, from 1 to `most`.
fn count(name: &'static str, given: f64, most: usize) -> Result<usize, Refusal> {
    if given >= 1.0 && given <= most as f64 {
        Ok(given as usize)
    } else {
        Err(Refusal::Range { name, value: given, expected: "a whole number, at least 1 and not too large" })
    }
}
