// One large cloth on many threads: each frame is stepped in bands of rows, and the threads take one band after the other. A
// phase begins when all bands have ended the one before, which a barrier sees to. The bits are those of one thread, for any
// number of threads.
//
//     cc -std=c11 -O2 -pthread -I include examples/c/bands.c target/release/libtaut.a -lm -o bands
//     ./bands [THREADS] [SIDE]
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "taut.h"

enum { MOST_THREADS = 16, MOST_SIDE = 512, FRAMES = 30, SUBSTEPS = 16, ROWS_PER_BAND = 16 };

#define TRY(call)                                                              \
    do {                                                                       \
        taut_result result_ = (call);                                          \
        if (result_ != TAUT_OK) {                                              \
            fprintf(stderr, "%s: %s\n", #call, taut_result_name(result_));     \
            exit(2);                                                           \
        }                                                                      \
    } while (0)

static int threads = 2;
static taut_cloth *cloth;
static taut_bands *bands; // of the frame that is being stepped; NULL at the end
static uint32_t count, phases;
static void *band_block;
static size_t band_bytes;
static atomic_uint next;

// A barrier whose last thread does something for all. Phases are short, so they wait by looking for a while before they sleep.
static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t all_here = PTHREAD_COND_INITIALIZER;
static int waiting;
static atomic_uint round_number;

static void meet(void (*last)(void))
{
    const unsigned round = atomic_load(&round_number);
    pthread_mutex_lock(&mutex);
    if (++waiting == threads) {
        waiting = 0;
        if (last) {
            last();
        }
        atomic_store(&next, 0);
        atomic_fetch_add(&round_number, 1);
        pthread_cond_broadcast(&all_here);
        pthread_mutex_unlock(&mutex);
        return;
    }
    pthread_mutex_unlock(&mutex);
    for (int looks = 0; looks < 20000; ++looks) {
        if (atomic_load(&round_number) != round) {
            return;
        }
    }
    pthread_mutex_lock(&mutex);
    while (atomic_load(&round_number) == round) {
        pthread_cond_wait(&all_here, &mutex);
    }
    pthread_mutex_unlock(&mutex);
}

static int frame;
static uint32_t flags;

static void next_frame(void)
{
    if (bands) {
        TRY(taut_bands_end(bands, &flags));
        bands = NULL;
    }
    if (frame++ < FRAMES) {
        TRY(taut_cloth_bands_begin(cloth, ROWS_PER_BAND, band_block, band_bytes, &bands));
        TRY(taut_bands_count(bands, &count, &phases));
    }
}

static void *work(void *unused)
{
    (void)unused;
    for (;;) {
        meet(next_frame);
        if (!bands) {
            return NULL;
        }
        const uint32_t of_frame = phases;
        for (uint32_t phase = 0; phase < of_frame; ++phase) {
            uint32_t band;
            while ((band = atomic_fetch_add(&next, 1)) < count) {
                TRY(taut_bands_run(bands, phase, band));
            }
            meet(NULL);
        }
    }
}

static double seconds(void)
{
    struct timespec now;
    timespec_get(&now, TIME_UTC);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// A level sheet that falls on two corners, held by tethers, in the wind and onto a ball.
static void start(uint32_t side)
{
    TRY(taut_cloth_reset(cloth));
    taut_air air = taut_air_default();
    air.wind_m_s[0] = 3.0f;
    air.gust = 0.5f;
    TRY(taut_cloth_set_air(cloth, &air));
    taut_collider_def ball = taut_collider_def_default(TAUT_SHAPE_SPHERE);
    ball.radius_m[0] = 0.2f;
    ball.pose.position_m[0] = 0.5;
    ball.pose.position_m[1] = -0.3;
    ball.pose.position_m[2] = 0.5;
    uint32_t id;
    TRY(taut_cloth_collider_add(cloth, &ball, &id));
    TRY(taut_cloth_set_stiffness_uniform(cloth, 1e6f, 1e6f, 3e5f, 2e4f));
    TRY(taut_cloth_pin(cloth, 0));
    TRY(taut_cloth_pin(cloth, side - 1));
}

int main(int argc, char **argv)
{
    threads = argc > 1 ? atoi(argv[1]) : 2;
    const int asked = argc > 2 ? atoi(argv[2]) : 128;
    if (threads < 1 || threads > MOST_THREADS || asked < ROWS_PER_BAND || asked > MOST_SIDE) {
        fprintf(stderr, "usage: bands [THREADS, 1 to %d] [SIDE, %d to %d]\n", MOST_THREADS, ROWS_PER_BAND, MOST_SIDE);
        return 2;
    }
    const uint32_t side = (uint32_t)asked;
    taut_grid_def grid_def = taut_grid_def_default();
    grid_def.rows = side;
    grid_def.columns = side;
    static _Alignas(TAUT_GRID_ALIGN) unsigned char grid_block[TAUT_GRID_BYTES];
    taut_grid *grid;
    TRY(taut_grid_create(&grid_def, grid_block, sizeof grid_block, &grid));
    taut_cloth_def def = taut_cloth_def_default(grid);
    def.substeps = SUBSTEPS;
    def.features = TAUT_FEATURE_TETHERS | TAUT_FEATURE_AIR | TAUT_FEATURE_COLLIDERS;
    def.max_pins = 2;
    def.v_axis[1] = 0.0f;
    def.v_axis[2] = 1.0f;
    taut_memory memory;
    TRY(taut_cloth_memory(grid, &def, &memory));
    const size_t cloth_bytes = (memory.size + memory.align - 1) / memory.align * memory.align;
    void *cloth_block = aligned_alloc(memory.align, cloth_bytes);
    if (!cloth_block) {
        return 2;
    }
    TRY(taut_cloth_create(grid, &def, cloth_block, cloth_bytes, &cloth));
    start(side);
    TRY(taut_cloth_bands_memory(cloth, ROWS_PER_BAND, &memory));
    band_bytes = (memory.size + memory.align - 1) / memory.align * memory.align;
    band_block = aligned_alloc(memory.align, band_bytes);
    if (!band_block) {
        return 2;
    }

    // one thread, as ever
    uint64_t serial, parallel;
    double begun = seconds();
    for (int i = 0; i < FRAMES; ++i) {
        TRY(taut_cloth_step(cloth, &flags));
    }
    const double alone_s = seconds() - begun;
    TRY(taut_cloth_state_hash(cloth, &serial));

    // many
    start(side);
    pthread_t all[MOST_THREADS];
    begun = seconds();
    for (int i = 0; i < threads; ++i) {
        if (pthread_create(&all[i], NULL, work, NULL) != 0) {
            return 2;
        }
    }
    for (int i = 0; i < threads; ++i) {
        pthread_join(all[i], NULL);
    }
    const double together_s = seconds() - begun;
    TRY(taut_cloth_state_hash(cloth, &parallel));
    printf("%u x %u, %u bands, %d threads, %s, %016llx\n", side, side, count, threads,
           parallel == serial ? "the bits of one thread" : "OTHER BITS THAN ONE THREAD", (unsigned long long)parallel);
    fprintf(stderr, "ms a frame: taut_cloth_step %.2f, bands %.2f\n", 1e3 * alone_s / FRAMES, 1e3 * together_s / FRAMES);
    free(band_block);
    free(cloth_block);
    return parallel == serial && flags == 0 ? 0 : 1;
}
