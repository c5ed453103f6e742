//! Sets the flags of the lanes that are compiled: `lanes_of_eight` for AVX2 or NEON, `lanes_of_sixteen` for
//! AVX-512.
//!
//! Without optimisation there are none, since compiling lanes takes longer than they save. The environment
//! variable `SPINCYL_COMPILED_LANES` overrides this: `all`, `one` (without AVX-512) or `none`.

fn main() {
    println!("cargo::rerun-if-env-changed=SPINCYL_COMPILED_LANES");
    println!("cargo::rustc-check-cfg=cfg(lanes_of_eight, lanes_of_sixteen, short_code)");
    let says = |name: &str| std::env::var(name).unwrap_or_default();
    if says("CARGO_CFG_TARGET_ARCH") == "wasm32" {
        println!("cargo::rustc-cfg=short_code");
    }
    let (x86, arm) = match says("CARGO_CFG_TARGET_ARCH").as_str() {
        "x86" | "x86_64" => (true, false),
        "aarch64" => (false, true),
        _ => (false, false),
    };
    let (eight, sixteen) = match says("SPINCYL_COMPILED_LANES").as_str() {
        "" => (says("OPT_LEVEL") != "0", says("OPT_LEVEL") != "0"),
        "all" => (true, true),
        "one" => (true, false),
        "none" => (false, false),
        other => panic!("SPINCYL_COMPILED_LANES={other}: expected all, one or none"),
    };
    if eight && (x86 || arm) {
        println!("cargo::rustc-cfg=lanes_of_eight");
    }
    if sixteen && x86 {
        println!("cargo::rustc-cfg=lanes_of_sixteen");
    }
}
