use crate::handle::{ClothHandle, GridHandle, TAUT_CLOTH_ALIGN, TAUT_CLOTH_HEADER_BYTES, change, grid};
use crate::pointer::{Out, array_mut, value};
use crate::result::{Code, answer};
use crate::types::{ClothDef, Memory};

const COOKIE: u32 = 0x686c_6374;

/// The default cloth for a grid: 60 Hz x 16 substeps, 0.2 kg/m^2, hanging from particle 0 in the direction -y. The grid
/// tells how many pins there can be; it may be NULL, which means a grid of 256 particles or more.
///
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_def_default(on: *const GridHandle) -> ClothDef {
    let d = taut_core::ClothDef::default();
    // SAFETY: the caller lends a grid, or NULL, which is answered.
    let max_pins = unsafe { grid(on) }.map_or(d.max_pins, |g| d.max_pins.min(g.particles() as u32));
    ClothDef {
        size: size_of::<ClothDef>() as u32,
        cookie: COOKIE,
        origin_m: d.origin_m,
        rate_hz: d.rate_hz,
        substeps: d.substeps,
        density_kg_m2: d.density_kg_m2,
        damping_per_s: d.damping_per_s,
        speed_limit: d.speed_limit,
        compression_limit: d.compression_limit.into(),
        budget: d.budget as u32,
        inertia_radius_m: d.inertia_radius_m,
        inertia_max: d.inertia_max,
        max_pins,
        solver: d.solver as u32,
        cg_iterations: d.cg_iterations,
        tether_slack: d.tether_slack,
        strain_limit: d.strain_limit,
        strain_passes: d.strain_passes,
        level_cycles: d.level_cycles,
        hinge_rigidity_n_m: d.hinge_rigidity_n_m,
        sleep_speed_m_s: d.sleep_speed_m_s,
        features: d.features.0,
        gravity_m_s2: d.gravity_m_s2,
        u_axis: d.u_axis,
        v_axis: d.v_axis,
    }
}

/// # Safety
/// As [`value`].
unsafe fn checked(def: *const ClothDef) -> Result<taut_core::ClothDef, Code> {
    // SAFETY: promised by the caller; a definition is plain numbers.
    check(unsafe { value(def) }?)
}

/// What core makes of a definition. It does not look at the numbers.
pub(crate) fn check(d: &ClothDef) -> Result<taut_core::ClothDef, Code> {
    if d.size as usize != size_of::<ClothDef>() || d.cookie != COOKIE {
        return Err(Code::TAUT_ERROR_BAD_DEFINITION);
    }
    let budget = match d.budget {
        b if b == taut_core::Budget::Certified as u32 => taut_core::Budget::Certified,
        b if b == taut_core::Budget::Tuned as u32 => taut_core::Budget::Tuned,
        _ => return Err(Code::TAUT_ERROR_OUT_OF_RANGE),
    };
    let solver = [taut_core::Solver::SymplecticEuler, taut_core::Solver::ImplicitEuler, taut_core::Solver::Bdf2]
        .into_iter()
        .find(|s| *s as u32 == d.solver)
        .ok_or(Code::TAUT_ERROR_OUT_OF_RANGE)?;
    if d.compression_limit > 1 {
        return Err(Code::TAUT_ERROR_OUT_OF_RANGE);
    }
    Ok(taut_core::ClothDef {
        rate_hz: d.rate_hz,
        substeps: d.substeps,
        density_kg_m2: d.density_kg_m2,
        gravity_m_s2: d.gravity_m_s2,
        damping_per_s: d.damping_per_s,
        speed_limit: d.speed_limit,
        compression_limit: d.compression_limit == 1,
        budget,
        inertia_radius_m: d.inertia_radius_m,
        inertia_max: d.inertia_max,
        max_pins: d.max_pins,
        solver,
        cg_iterations: d.cg_iterations,
        tether_slack: d.tether_slack,
        strain_limit: d.strain_limit,
        strain_passes: d.strain_passes,
        level_cycles: d.level_cycles,
        hinge_rigidity_n_m: d.hinge_rigidity_n_m,
        sleep_speed_m_s: d.sleep_speed_m_s,
        features: taut_core::Features(d.features),
        origin_m: d.origin_m,
        u_axis: d.u_axis,
        v_axis: d.v_axis,
    })
}

/// Memory that a cloth needs. For static storage TAUT_CLOTH_BYTES tells the same at compile time.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE (grid), TAUT_ERROR_BAD_DEFINITION,
/// TAUT_ERROR_STEP_SIZE, TAUT_ERROR_DAMPING, TAUT_ERROR_NOT_FINITE, TAUT_ERROR_NEGATIVE, TAUT_ERROR_OUT_OF_RANGE.
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_memory(on: *const GridHandle, def: *const ClothDef, out: *mut Memory) -> Code {
    answer(|| {
        // SAFETY: the caller lends a grid, a definition and a place for the answer.
        let (grid, def, out) = unsafe { (grid(on)?, checked(def)?, Out::new(out)?) };
        out.set(Memory { size: bytes(taut_core::Cloth::memory(grid, &def)?)?, align: TAUT_CLOTH_ALIGN });
        Ok(())
    })
}

/// Bytes of a block that holds so many numbers.
fn bytes(numbers: usize) -> Result<usize, Code> {
    numbers
        .checked_mul(size_of::<f32>())
        .and_then(|b| b.checked_add(TAUT_CLOTH_HEADER_BYTES))
        .ok_or(Code::TAUT_ERROR_OUT_OF_RANGE)
}

/// Makes a cloth in the caller's block of block_size bytes: flat, at rest, nothing pinned, without stiffness. The content of
/// the block does not matter. The block is the caller's to keep until the cloth is no longer used, and then to free; there
/// is nothing to destroy. It must stay where it is: a copy of it is no cloth (use a snapshot).
///
/// Errors: those of taut_cloth_memory, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BLOCK_TOO_SMALL. Then the block is as it was.
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_create(
    on: *const GridHandle,
    def: *const ClothDef,
    block: *mut core::ffi::c_void,
    block_size: usize,
    out: *mut *mut ClothHandle,
) -> Code {
    answer(|| {
        // SAFETY: the caller lends a grid, a definition and a place for the answer.
        let (grid, def, out) = unsafe { (grid(on)?, checked(def)?, Out::new(out)?) };
        let numbers = taut_core::Cloth::memory(grid, &def)?;
        let handle = block.cast::<ClothHandle>();
        // SAFETY: the caller hands in a block of his own; an array of no values only checks the pointer.
        unsafe { array_mut(handle, 0) }?;
        if block_size < bytes(numbers)? {
            return Err(Code::TAUT_ERROR_BLOCK_TOO_SMALL);
        }
        // SAFETY: the block is the caller's own, not NULL, aligned, and holds the header and then so many numbers. They are
        // set to zero before they are looked at, since fresh memory may be uninitialised. The cloth is the only owner of
        // the numbers for as long as the handle is used, and the header is no part of them.
        let planes = unsafe {
            let first = block.byte_add(TAUT_CLOTH_HEADER_BYTES).cast::<f32>();
            first.write_bytes(0, numbers);
            array_mut(first, numbers)?
        };
        let cloth = taut_core::Cloth::create(grid, &def, planes)?;
        // SAFETY: not NULL, aligned, and TAUT_CLOTH_HEADER_BYTES hold a handle.
        unsafe { handle.write(ClothHandle::new(cloth, handle.addr())) };
        out.set(handle);
        Ok(())
    })
}

/// Back to the start: flat, at rest, nothing pinned, no collider, step 0, gravity, damping, air, targets, frame and rest lengths
/// as they were made. Stiffness, masses and mask stay.
///
/// Errors: TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE.
/// Threads: changes the cloth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn taut_cloth_reset(cloth: *mut ClothHandle) -> Code {
    // SAFETY: the caller hands in a cloth that nobody else uses.
    unsafe {
        change(cloth, |cloth| {
            cloth.reset();
            Ok(())
        })
    }
}
