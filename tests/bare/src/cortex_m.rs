//! A Cortex-M4 with a float unit, by semihosting: what `targets.sh` runs in an emulator.

use core::arch::asm;

/// Whether the machine is fast enough for the long runs.
pub const FAST: bool = false;

const WRITE0: u32 = 0x04;
const EXIT: u32 = 0x18;
const STOPPED: u32 = 0x2_0026;
const RUN_TIME_ERROR: u32 = 0x2_0023;

/// The coprocessor access register; its bits 20 to 23 switch the float unit on.
const CPACR: *mut u32 = 0xe000_ed88 as *mut u32;

/// What follows the initial stack pointer, which the linker script writes, in the vector table.
#[unsafe(link_section = ".vectors")]
#[used]
static RESET: unsafe extern "C" fn() -> ! = reset;

/// Where the processor starts. The emulator has loaded everything and memory is zero.
unsafe extern "C" fn reset() -> ! {
    // SAFETY: the register exists on every Cortex-M4, and nothing has used a float so far.
    unsafe {
        CPACR.write_volatile(0xf << 20);
        asm!("dsb", "isb");
    }
    start()
}

/// Apart, so that no float instruction moves before the float unit is on.
#[inline(never)]
fn start() -> ! {
    crate::main()
}

fn host(operation: u32, argument: u32) {
    // SAFETY: the emulator serves this breakpoint; it writes r0 and reads what the argument points to.
    unsafe { asm!("bkpt 0xab", inout("r0") operation => _, in("r1") argument) }
}

/// Writes a text that ends with a zero byte.
pub fn write(text: &[u8]) {
    if text.last() == Some(&0) {
        host(WRITE0, text.as_ptr() as u32);
    }
}

/// Flush-to-zero, quiet default NaNs and rounding upwards.
pub fn set_modes_of_an_engine() -> bool {
    let modes = 1u32 << 25 | 1 << 24 | 1 << 22;
    // SAFETY: sets modes that are allowed; only whole numbers are computed in this crate.
    unsafe { asm!("vmsr fpscr, {}", in(reg) modes, options(nostack)) };
    true
}

/// Ends the emulator with 0 or 1.
pub fn exit(code: i32) -> ! {
    host(EXIT, if code == 0 { STOPPED } else { RUN_TIME_ERROR });
    loop {}
}
