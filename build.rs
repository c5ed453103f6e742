//! Says whether lanes are compiled: not in a program without any optimisation, which would wait for them longer than it gains.

fn main() {
    println!("cargo::rerun-if-env-changed=SPINCYL_UNOPTIMISED_LANES");
    println!("cargo::rustc-check-cfg=cfg(no_lanes)");
    let unoptimised = std::env::var("OPT_LEVEL").is_ok_and(|level| level == "0");
    if unoptimised && std::env::var_os("SPINCYL_UNOPTIMISED_LANES").is_none() {
        println!("cargo::rustc-cfg=no_lanes");
    }
}
