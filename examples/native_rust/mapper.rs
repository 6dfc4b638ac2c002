// The interface of native mappers from Rust: topo_verify.h, written down again.
//
//     rustc -O --crate-type cdylib -o mapper.so mapper.rs
//     topo-verify search --library ./mapper.so --edges 4
//
// With `--cfg wrong` it takes the marker's dart for the dart by which it came in.
//
// This sketch maps the worlds of one vertex, where the marker is always seen: there the percept says
// by which dart the robot came in. All other worlds it skips, so a search says UNKNOWN of them.
use std::os::raw::{c_char, c_void};

#[repr(C)]
pub struct Evidence {
    step: i64,
    expected: i64,
    observed: i64,
    sequence: i64,
    at: i64,
    record: i64,
    contradiction: i64,
}

#[repr(C)]
pub struct Robot {
    version: i64,
    world: *mut c_void,
    look: extern "C" fn(*mut c_void) -> i64,
    step: extern "C" fn(*mut c_void, i64, i64) -> i64,
    pose: extern "C" fn(*mut c_void, i64, i64, *const i64) -> i64,
    reject: extern "C" fn(*mut c_void, i64, i64, i64, *const Evidence, i64, *const i64) -> i64,
    confirm: extern "C" fn(*mut c_void, i64, i64, i64) -> i64,
    augment: extern "C" fn(*mut c_void, i64, i64, i64, i64) -> i64,
    deliver: extern "C" fn(*mut c_void, i64, *const i64, *const i64, i64, i64) -> i64,
    skip: extern "C" fn(*mut c_void, *const c_char) -> i64,
}

/// The degree, and the door of the marker if it is here; a refused robot sees degree -1.
fn percept(word: i64) -> (i64, Option<i64>) {
    let here = word >= 0 && word & 65535 != 0;
    (word >> 16, if here { Some((word & 65535) - 1) } else { None })
}

/// Whether the world has one vertex, and is mapped.
fn explore(robot: &Robot) -> bool {
    let (degree, _) = percept((robot.look)(robot.world));
    let mut ends = vec![-1i64; degree as usize];
    let (mut at, mut cost) = (0i64, 0i64);
    while let Some(edge) = ends.iter().position(|&dart| dart < 0) {
        let door = (edge as i64 - at).rem_euclid(degree);
        let (_, marker) = percept((robot.step)(robot.world, door, -1));
        cost += 1;
        let Some(door) = marker else { return false };
        at = if cfg!(wrong) { door } else { (degree - door) % degree }; // the marker's dart is 0
        ends[edge] = at;
        ends[at as usize] = edge as i64;
    }
    let marker = if degree > 0 { 0 } else { -1 };
    (robot.deliver)(robot.world, 1, &degree, ends.as_ptr(), marker, cost);
    true
}

#[no_mangle]
pub extern "C" fn map_world(robot: &Robot) {
    // No panic may pass the border to C.
    match std::panic::catch_unwind(|| explore(robot)) {
        Ok(true) => {}
        Ok(false) => {
            (robot.skip)(robot.world, b"it has several vertices\0".as_ptr().cast());
        }
        Err(_) => std::process::abort(),
    }
}
