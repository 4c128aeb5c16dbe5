// Part of refusals.c: the mistakes of the planner.

static int plans(void)
{
    taut_grid_def on = taut_grid_def_default();
    taut_plan_def def = taut_plan_def_default();
    taut_settings settings;
    memset(&settings, 0xa5, sizeof settings);
    const taut_settings untouched = settings;
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_plan(NULL, &def, &settings));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_plan(&on, NULL, &settings));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_plan(&on, &def, NULL));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_plan(&on, off(&def), &settings));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_plan(&on, &def, off(&settings)));
#define WRONG_PLAN(code, field, value)                     \
    do {                                                   \
        taut_plan_def wrong_ = def;                        \
        wrong_.field = (value);                            \
        REFUSED(code, taut_plan(&on, &wrong_, &settings)); \
    } while (0)
    WRONG_PLAN(TAUT_ERROR_BAD_DEFINITION, size, def.size - 4);
    WRONG_PLAN(TAUT_ERROR_BAD_DEFINITION, cookie, 0);
    WRONG_PLAN(TAUT_ERROR_OUT_OF_RANGE, hold, 6);
    WRONG_PLAN(TAUT_ERROR_OUT_OF_RANGE, tolerance, 0.0f);
    WRONG_PLAN(TAUT_ERROR_OUT_OF_RANGE, budget_ns, -1.0f);
    WRONG_PLAN(TAUT_ERROR_OUT_OF_RANGE, plain_ns, 0.0f);
    WRONG_PLAN(TAUT_ERROR_NOT_FINITE, tolerance, (float)NAN);
    WRONG_PLAN(TAUT_ERROR_NEGATIVE, stiffness_n_m[2], -1.0f);
    WRONG_PLAN(TAUT_ERROR_STEP_SIZE, rate_hz, 0.0f);
    WRONG_PLAN(TAUT_ERROR_NO_PLAN, budget_ns, 1.0f);
#undef WRONG_PLAN
    taut_cloth_def cloth_def = taut_cloth_def_default(NULL);
    REQUIRE(taut_plan(&on, &def, &settings) == TAUT_OK);
    const taut_grid_def on_before = on;
    const taut_cloth_def cloth_before = cloth_def;
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_plan_apply(NULL, &on, &cloth_def));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_plan_apply(&settings, NULL, &cloth_def));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_plan_apply(&settings, &on, NULL));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_plan_apply(off(&settings), &on, &cloth_def));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_plan_apply(&untouched, &on, &cloth_def));
    taut_settings wrong_settings = settings;
    wrong_settings.level_cycles = 33;
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_plan_apply(&wrong_settings, &on, &cloth_def));
    wrong_settings = settings;
    wrong_settings.speed_limit = (float)NAN;
    REFUSED(TAUT_ERROR_NOT_FINITE, taut_plan_apply(&wrong_settings, &on, &cloth_def));
    cloth_def.cookie = 0;
    REFUSED(TAUT_ERROR_BAD_DEFINITION, taut_plan_apply(&settings, &on, &cloth_def));
    cloth_def.cookie = cloth_before.cookie;
    REQUIRE(!memcmp(&on, &on_before, sizeof on) && !memcmp(&cloth_def, &cloth_before, sizeof cloth_def));
    memset(&settings, 0xa5, sizeof settings);
    on.rows = 1;
    REFUSED(TAUT_ERROR_GRID_SIZE, taut_plan(&on, &def, &settings));
    REQUIRE(!memcmp(&settings, &untouched, sizeof settings));
    return 0;
}
