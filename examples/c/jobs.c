// Many cloths on many threads: in each frame the threads take one cloth after the other from a common list, so a cloth is
// stepped by another thread in another frame, but never by two at a time. That is all the locking that taut needs: cloths share
// nothing but the grid, which never changes. The bits are those of one thread.
//
//     cc -std=c11 -pthread -I include examples/c/jobs.c target/release/libtaut.a -o jobs
//     ./jobs
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>

#include "taut.h"

enum {
    SIDE = 12,
    CLOTHS = 32,
    THREADS = 4,
    FRAMES = 120,
    CLOTH_BYTES = TAUT_CLOTH_BYTES(SIDE, SIDE, TAUT_FAMILY_ALL, TAUT_FEATURE_NONE, 2),
};

// The size is a multiple of the alignment, so that the blocks can stand side by side.
_Static_assert(CLOTH_BYTES % TAUT_CLOTH_ALIGN == 0, "padding between the blocks");
static _Alignas(TAUT_GRID_ALIGN) unsigned char grid_block[TAUT_GRID_BYTES];
static _Alignas(TAUT_CLOTH_ALIGN) unsigned char cloth_blocks[CLOTHS][CLOTH_BYTES];
static taut_cloth *cloths[CLOTHS];
static uint32_t flags[CLOTHS];

static atomic_int next;    // the next cloth of the list
static atomic_int failures;
static int stepped_by[THREADS];

// All threads wait for each other at the end of a frame.
static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t all_here = PTHREAD_COND_INITIALIZER;
static int waiting;
static unsigned frame_number;

static void end_of_frame(void)
{
    pthread_mutex_lock(&mutex);
    const unsigned frame = frame_number;
    if (++waiting == THREADS) {
        waiting = 0;
        ++frame_number;
        atomic_store(&next, 0);
        pthread_cond_broadcast(&all_here);
    } else {
        while (frame == frame_number) {
            pthread_cond_wait(&all_here, &mutex);
        }
    }
    pthread_mutex_unlock(&mutex);
}

static void *work(void *argument)
{
    int *count = argument;
    for (int frame = 0; frame < FRAMES; ++frame) {
        int i;
        while ((i = atomic_fetch_add(&next, 1)) < CLOTHS) {
            if (taut_cloth_step(cloths[i], &flags[i]) != TAUT_OK || flags[i] != 0) {
                atomic_fetch_add(&failures, 1);
            }
            ++*count;
        }
        end_of_frame();
    }
    return NULL;
}

// All cloths at their start, each of its own pins and stiffness.
static int start(void)
{
    for (int i = 0; i < CLOTHS; ++i) {
        const float k = 200.0f + 50.0f * (float)i;
        if (taut_cloth_reset(cloths[i]) != TAUT_OK || taut_cloth_pin(cloths[i], 0) != TAUT_OK ||
            taut_cloth_pin(cloths[i], 1 + (uint32_t)i % (SIDE - 1)) != TAUT_OK ||
            taut_cloth_set_stiffness_uniform(cloths[i], k, k, 0.3f * k, 0.01f * k) != TAUT_OK) {
            return 0;
        }
    }
    return 1;
}

int main(void)
{
    taut_grid_def grid_def = taut_grid_def_default();
    grid_def.rows = SIDE;
    grid_def.columns = SIDE;
    taut_grid *grid;
    if (taut_check_version(TAUT_VERSION_ID) != TAUT_OK ||
        taut_grid_create(&grid_def, grid_block, sizeof grid_block, &grid) != TAUT_OK) {
        return 2;
    }
    taut_cloth_def def = taut_cloth_def_default(grid);
    def.max_pins = 2;
    for (int i = 0; i < CLOTHS; ++i) {
        if (taut_cloth_create(grid, &def, cloth_blocks[i], CLOTH_BYTES, &cloths[i]) != TAUT_OK) {
            return 2;
        }
    }

    // one thread
    static uint64_t serial[CLOTHS], parallel[CLOTHS];
    if (!start()) {
        return 2;
    }
    for (int frame = 0; frame < FRAMES; ++frame) {
        if (taut_cloth_step_all(cloths, CLOTHS, flags) != TAUT_OK) {
            return 2;
        }
    }
    for (int i = 0; i < CLOTHS; ++i) {
        if (taut_cloth_state_hash(cloths[i], &serial[i]) != TAUT_OK) {
            return 2;
        }
    }

    // many threads
    if (!start()) {
        return 2;
    }
    pthread_t threads[THREADS];
    for (int i = 0; i < THREADS; ++i) {
        if (pthread_create(&threads[i], NULL, work, &stepped_by[i]) != 0) {
            return 2; // the others wait for ever, and end with the program
        }
    }
    int steps = 0;
    for (int i = 0; i < THREADS; ++i) {
        pthread_join(threads[i], NULL);
        steps += stepped_by[i];
    }
    int different = 0;
    for (int i = 0; i < CLOTHS; ++i) {
        if (taut_cloth_state_hash(cloths[i], &parallel[i]) != TAUT_OK) {
            return 2;
        }
        different += parallel[i] != serial[i];
    }

    // the hash of all hashes, so that two machines can compare one number
    uint64_t all = 0;
    for (int i = 0; i < CLOTHS; ++i) {
        all = all * 0x9e3779b97f4a7c15u + parallel[i];
    }
    printf("%d cloths, %d threads, %d steps, %d different from one thread, %016llx\n", CLOTHS, THREADS, steps, different,
           (unsigned long long)all);
    return different == 0 && steps == CLOTHS * FRAMES && atomic_load(&failures) == 0 ? 0 : 1;
}
