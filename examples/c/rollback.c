// Rollback as network games do it: a player goes on with what it believes the other one does. When the truth arrives 60 frames
// late, the cloth goes back to where the two part and steps those frames again. Then it has the very bits that it would have
// had with the truth from the start.
//
//     cc -std=c11 -I include examples/c/rollback.c target/release/libtaut.a -o rollback
//     ./rollback
#include <stdio.h>

#include "taut.h"

enum {
    SIDE = 16,
    LATE = 60,          // frames until the truth arrives
    PARTED = 120,       // the frame in which the other player does something else than was believed
    NOW = PARTED + LATE,
    SNAPSHOT_BYTES = 16 * 1024,
};

static _Alignas(TAUT_GRID_ALIGN) unsigned char grid_block[TAUT_GRID_BYTES];
static _Alignas(TAUT_CLOTH_ALIGN) unsigned char
    cloth_block[TAUT_CLOTH_BYTES(SIDE, SIDE, TAUT_FAMILY_ALL, TAUT_FEATURE_PULL, SIDE)];

// The last frames: the state before each of them, and its hash. A frame further back cannot be corrected any more.
static unsigned char snapshots[LATE][SNAPSHOT_BYTES];
static size_t sizes[LATE];
static uint64_t hashes[NOW + 1];

// Leaves the function with 0 and says what failed.
#define TRY(call)                                                              \
    do {                                                                       \
        taut_result result_ = (call);                                          \
        if (result_ != TAUT_OK) {                                              \
            fprintf(stderr, "%s: %s (%s)\n", #call, taut_result_message(result_), taut_result_name(result_)); \
            return 0;                                                          \
        }                                                                      \
    } while (0)

// What the players do in a frame. The other one lets go of a corner and pulls, if that is what he does.
static int input(taut_cloth *cloth, int frame, int other_pulls)
{
    const double hand_m[3] = {0.001 * frame, 0.0, 0.002 * (frame % 30)};
    TRY(taut_cloth_pin_move(cloth, 0, hand_m));
    if (other_pulls && frame == PARTED) {
        TRY(taut_cloth_unpin(cloth, SIDE - 1));
    }
    if (other_pulls && frame >= PARTED) {
        const float force_n[3] = {0.0f, 0.0f, 0.3f};
        TRY(taut_cloth_add_force(cloth, SIDE * SIDE - 1, force_n));
    }
    return 1;
}

// Steps the frames from first to last - 1, keeping a snapshot of each.
static int play(taut_cloth *cloth, int first, int last, int other_pulls)
{
    for (int frame = first; frame < last; ++frame) {
        const int slot = frame % LATE;
        TRY(taut_cloth_snapshot(cloth, snapshots[slot], SNAPSHOT_BYTES, &sizes[slot]));
        if (!input(cloth, frame, other_pulls)) {
            return 0;
        }
        TRY(taut_cloth_step(cloth, NULL));
        TRY(taut_cloth_state_hash(cloth, &hashes[frame + 1]));
    }
    return 1;
}

static int start(taut_cloth *cloth)
{
    TRY(taut_cloth_reset(cloth));
    TRY(taut_cloth_pin(cloth, 0));
    TRY(taut_cloth_pin(cloth, SIDE - 1));
    return 1;
}

// Back to before the frame `PARTED`. A snapshot that is damaged or belongs to another cloth is refused whole.
static int go_back(taut_cloth *cloth)
{
    TRY(taut_cloth_restore(cloth, snapshots[PARTED % LATE], sizes[PARTED % LATE]));
    return 1;
}

int main(void)
{
    taut_grid_def grid_def = taut_grid_def_default();
    grid_def.rows = SIDE;
    grid_def.columns = SIDE;
    taut_grid *grid;
    taut_cloth *cloth;
    if (taut_check_version(TAUT_VERSION_ID) != TAUT_OK ||
        taut_grid_create(&grid_def, grid_block, sizeof grid_block, &grid) != TAUT_OK) {
        return 2;
    }
    taut_cloth_def def = taut_cloth_def_default(grid);
    def.inertia_radius_m = 0.3f;
    def.max_pins = SIDE;
    def.features = TAUT_FEATURE_PULL;
    size_t most;
    if (taut_cloth_create(grid, &def, cloth_block, sizeof cloth_block, &cloth) != TAUT_OK ||
        taut_cloth_set_stiffness_uniform(cloth, 1000.0f, 600.0f, 200.0f, 8.0f) != TAUT_OK ||
        taut_cloth_snapshot_size_max(cloth, &most) != TAUT_OK || most > SNAPSHOT_BYTES) {
        return 2;
    }
    printf("a snapshot takes at most %d bytes\n", (int)most);

    // the truth, as the other player's machine has it
    if (!start(cloth) || !play(cloth, 0, NOW, 1)) {
        return 2;
    }
    const uint64_t truth = hashes[NOW];
    printf("the truth     %016llx\n", (unsigned long long)truth);

    // what this machine believes until it hears of it
    if (!start(cloth) || !play(cloth, 0, NOW, 0)) {
        return 2;
    }
    const uint64_t believed = hashes[NOW];
    printf("believed      %016llx\n", (unsigned long long)believed);

    // nothing new arrived: to go back and step the same frames again changes nothing
    if (!go_back(cloth) || !play(cloth, PARTED, NOW, 0)) {
        return 2;
    }
    const uint64_t replayed = hashes[NOW];
    printf("replayed      %016llx\n", (unsigned long long)replayed);

    // the truth arrived
    if (!go_back(cloth) || !play(cloth, PARTED, NOW, 1)) {
        return 2;
    }
    const uint64_t corrected = hashes[NOW];
    printf("corrected     %016llx\n", (unsigned long long)corrected);
    return replayed == believed && corrected == truth && believed != truth ? 0 : 1;
}
