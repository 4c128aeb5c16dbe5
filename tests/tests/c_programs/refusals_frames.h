// A part of refusals.c: frames that are refused.

// A frame that ends with a number that is not finite is taken back, and says so. To get there: the tuned budget without the
// speed limit and the damping that it needs, from a start that no cloth ever saw.
static int taken_back(void)
{
    taut_cloth_def def = taut_cloth_def_default(grid);
    def.max_pins = 4;
    def.features = TAUT_FEATURE_PULL;
    def.speed_limit = 0;
    def.damping_per_s = 0;
    taut_cloth *wild;
    DONE(taut_cloth_create(grid, &def, spare, BYTES, &wild));
    DONE(taut_cloth_set_stiffness_uniform(wild, 1e6f, 1e6f, 1e6f, 1e4f));
    static float start[SIDE * SIDE][3];
    for (int i = 0; i < SIDE * SIDE; ++i) {
        const int odd = (i / SIDE + i % SIDE) % 2;
        start[i][0] = start[i][1] = start[i][2] = odd ? 1e5f : -1e5f;
    }
    DONE(taut_cloth_set_positions(wild, SIDE * SIDE, start[0]));
    uint32_t flags = 0;
    uint64_t hash = 0, after, index;
    int frames = 0;
    while (frames < 1000 && flags == 0) {
        DONE(taut_cloth_state_hash(wild, &hash));
        DONE(taut_cloth_step(wild, &flags));
        ++frames;
    }
    REQUIRE(flags == (TAUT_STEP_NON_FINITE | TAUT_STEP_NON_FINITE_STATE));
    DONE(taut_cloth_state_hash(wild, &after));
    DONE(taut_cloth_step_index(wild, &index));
    REQUIRE(after == hash && (int)index == frames - 1);
    DONE(taut_cloth_step_many(wild, 10, &flags)); // it would end so again, so the other nine are not tried
    DONE(taut_cloth_step_index(wild, &index));
    REQUIRE(flags == (TAUT_STEP_NON_FINITE | TAUT_STEP_NON_FINITE_STATE) && (int)index == frames - 1);
    return 0;
}
