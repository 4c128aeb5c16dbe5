// Part of refusals.c: the mistakes of what a renderer reads, and of the list of cloths.

// What a renderer reads, and the list of cloths.
static int meshes(void)
{
    enum { TRIANGLES = 2 * (SIDE - 1) * (SIDE - 1), PARTICLES = SIDE * SIDE };
    uint32_t count = 7;
    taut_bounds bounds;
    memset(bytes, 0xa5, sizeof bytes);
    memset(spare, 0, sizeof spare);
    const taut_grid *wrong[] = {NULL, off(grid), (taut_grid *)(void *)spare};
    const taut_result answers[] = {TAUT_ERROR_NULL_POINTER, TAUT_ERROR_MISALIGNED, TAUT_ERROR_BAD_HANDLE};
    for (int i = 0; i < 3; ++i) {
        REFUSED(answers[i], taut_grid_triangle_count(wrong[i], &count));
        REFUSED(answers[i], taut_grid_copy_triangles_u32(wrong[i], bytes, sizeof bytes));
        REFUSED(answers[i], taut_grid_copy_triangles_u16(wrong[i], bytes, sizeof bytes));
        REFUSED(answers[i], taut_grid_copy_uvs_f32(wrong[i], bytes, sizeof bytes, 8));
    }
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_grid_triangle_count(grid, NULL));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_grid_triangle_count(grid, off(bytes)));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_grid_copy_triangles_u32(grid, NULL, sizeof bytes));
    REFUSED(TAUT_ERROR_BLOCK_TOO_SMALL, taut_grid_copy_triangles_u32(grid, bytes, 12 * TRIANGLES - 1));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_grid_copy_triangles_u16(grid, NULL, sizeof bytes));
    REFUSED(TAUT_ERROR_BLOCK_TOO_SMALL, taut_grid_copy_triangles_u16(grid, bytes, 6 * TRIANGLES - 1));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_grid_copy_uvs_f32(grid, NULL, sizeof bytes, 8));
    REFUSED(TAUT_ERROR_SHAPE, taut_grid_copy_uvs_f32(grid, bytes, sizeof bytes, 7));
    REFUSED(TAUT_ERROR_BLOCK_TOO_SMALL, taut_grid_copy_uvs_f32(grid, bytes, 8 * PARTICLES - 1, 8));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_copy_normals_f32(cloth, NULL, sizeof bytes, 12));
    REFUSED(TAUT_ERROR_SHAPE, taut_cloth_copy_normals_f32(cloth, bytes, sizeof bytes, 11));
    REFUSED(TAUT_ERROR_BLOCK_TOO_SMALL, taut_cloth_copy_normals_f32(cloth, bytes, 12 * PARTICLES - 1, 12));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_bounds(cloth, NULL));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_cloth_bounds(cloth, off(bytes)));
    for (size_t i = 0; i < sizeof bytes; ++i) {
        REQUIRE(bytes[i] == 0xa5);
    }
    REQUIRE(count == 7);

    // what is written is written exactly, aligned or not
    DONE(taut_grid_triangle_count(grid, &count));
    REQUIRE(count == TRIANGLES && count == TAUT_TRIANGLES(SIDE, SIDE));
    DONE(taut_grid_copy_triangles_u32(grid, bytes + 1, 12 * TRIANGLES));
    REQUIRE(bytes[0] == 0xa5 && bytes[12 * TRIANGLES] != 0xa5 && bytes[12 * TRIANGLES + 1] == 0xa5);
    memset(bytes, 0xa5, sizeof bytes);
    DONE(taut_grid_copy_triangles_u16(grid, bytes + 1, 6 * TRIANGLES));
    REQUIRE(bytes[0] == 0xa5 && bytes[6 * TRIANGLES] != 0xa5 && bytes[6 * TRIANGLES + 1] == 0xa5);
    memset(bytes, 0xa5, sizeof bytes);
    DONE(taut_grid_copy_uvs_f32(grid, bytes + 1, 13 * (PARTICLES - 1) + 8, 13));
    DONE(taut_cloth_copy_normals_f32(cloth, bytes + 9 + 13 * PARTICLES, 13 * (PARTICLES - 1) + 12, 13));
    REQUIRE(bytes[0] == 0xa5 && bytes[9] == 0xa5 && bytes[13] == 0xa5 && bytes[14] != 0xa5);
    REQUIRE(bytes[9 + 13 * PARTICLES + 12] == 0xa5 && bytes[9 + 13 * 2 * PARTICLES - 1] == 0xa5);
    DONE(taut_cloth_bounds(cloth, &bounds));

    // 16 bits number 65,536 particles and no more
    static _Alignas(TAUT_GRID_ALIGN) unsigned char large_block[TAUT_GRID_BYTES];
    static uint16_t large[TAUT_TRIANGLES(256, 256)][3];
    taut_grid_def def = taut_grid_def_default();
    taut_grid *large_grid;
    def.rows = def.columns = 256;
    DONE(taut_grid_create(&def, large_block, sizeof large_block, &large_grid));
    DONE(taut_grid_copy_triangles_u16(large_grid, large, sizeof large));
    REQUIRE(large[TAUT_TRIANGLES(256, 256) - 1][2] == 65535);
    def.columns = 257;
    DONE(taut_grid_create(&def, large_block, sizeof large_block, &large_grid));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_grid_copy_triangles_u16(large_grid, large, sizeof large));

    // lists
    taut_cloth *list[2] = {cloth, cloth};
    uint32_t flags[2] = {7, 7};
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_step_all(NULL, 2, flags));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_cloth_step_all((taut_cloth **)off(list), 1, flags));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_cloth_step_all(list, 2, off(flags)));
    taut_cloth_def without = taut_cloth_def_default(grid);
    without.max_pins = 4;
    DONE(taut_cloth_create(grid, &without, spare, BYTES, &list[1]));
    REFUSED(TAUT_ERROR_NO_STIFFNESS, taut_cloth_step_all(list, 2, flags));
    DONE(taut_cloth_step_all(list, 0, flags));
    REQUIRE(flags[0] == 7 && flags[1] == 7);
    uint64_t index;
    DONE(taut_cloth_set_stiffness_uniform(list[1], 1, 1, 1, 1));
    list[0] = list[1];
    DONE(taut_cloth_step_all(list, 2, flags)); // named twice
    DONE(taut_cloth_step_all(list, 1, NULL));
    DONE(taut_cloth_step_index(list[1], &index));
    REQUIRE(index == 3 && flags[0] == 0 && flags[1] == 0);

    // a frame in bands
    static _Alignas(TAUT_CLOTH_ALIGN) unsigned char band_block[64 * 1024];
    taut_memory memory;
    taut_bands *bands;
    uint32_t number, phases;
    uint64_t hash_before, hash_after;
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_cloth_bands_memory(list[1], 7, &memory));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_bands_memory(list[1], 8, NULL));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_bands_memory(NULL, 8, &memory));
    DONE(taut_cloth_bands_memory(list[1], 8, &memory));
    REQUIRE(memory.align == TAUT_CLOTH_ALIGN && memory.size <= sizeof band_block);
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_bands_begin(list[1], 8, NULL, memory.size, &bands));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_cloth_bands_begin(list[1], 8, off(band_block), memory.size, &bands));
    REFUSED(TAUT_ERROR_BLOCK_TOO_SMALL, taut_cloth_bands_begin(list[1], 8, band_block, memory.size - 1, &bands));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_cloth_bands_begin(list[1], 8, band_block, memory.size, NULL));
    REFUSED(TAUT_ERROR_BAD_HANDLE, taut_bands_run((taut_bands *)(void *)band_block, 0, 0));
    DONE(taut_cloth_state_hash(list[1], &hash_before));
    DONE(taut_cloth_bands_begin(list[1], 8, band_block, memory.size, &bands));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_bands_count(bands, NULL, &phases));
    REFUSED(TAUT_ERROR_NULL_POINTER, taut_bands_count(bands, &number, NULL));
    DONE(taut_bands_count(bands, &number, &phases));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_bands_run(bands, 0, number));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_bands_run(bands, 1, 0));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_bands_run(bands, phases, 0));
    DONE(taut_bands_run(bands, 0, 0));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_bands_run(bands, 0, 0));
    REFUSED(TAUT_ERROR_MISALIGNED, taut_bands_end(bands, off(flags)));
    REFUSED(TAUT_ERROR_OUT_OF_RANGE, taut_bands_end(bands, flags)); // phases to go: taken back
    REFUSED(TAUT_ERROR_BAD_HANDLE, taut_bands_end(bands, flags));
    DONE(taut_cloth_state_hash(list[1], &hash_after));
    REQUIRE(hash_before == hash_after);
    return 0;
}
