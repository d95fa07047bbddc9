// The functions by which the browser client writes to its page. page/bridge.js implements them.
// Texts are UTF-8 and may come from the server, so the page shows them as text, never as HTML.
// Thread: the page's only one.
#pragma once
#include <cstdint>

extern "C" {
/// Shows the progress of joining. `share` is 0 to 1, or negative if it is not known. `detail` may
/// be empty.
void page_progress(const char* text, double share, const char* detail);
/// Hides the progress of joining and shows the world.
void page_joined(void);
/// Shows a line about the state while playing, such as a lost connection. Empty: none.
void page_state(const char* text);
/// Ends the play, and shows a headline and the exact reason.
void page_failed(const char* headline, const char* detail);
/// Shows a text for some seconds.
void page_notice(const char* text, int is_warning);
/// Adds a line to the chat. `id`: of a line of a player; otherwise empty.
void page_chat(const char* text, const char* id);
/// Removes the lines of the chat with this id.
void page_withdraw_chat(const char* id);
/// Opens the line in which the player types.
void page_open_chat(void);
/// Empties the list of materials.
void page_clear_materials(void);
/// Adds a material to the list. `colour` is 0xRRGGBB.
void page_material(int id, const char* name, std::uint32_t colour);
/// Opens or closes the list of materials.
void page_toggle_palette(void);
/// Sets a slot of the hotbar.
void page_slot(int slot, int material, int is_chosen);
/// Sets the number of other players, and their names, separated by line ends.
void page_players(int count, const char* names);
/// Shows whether the player flies or walks.
void page_walking(int is_walking);
/// Captures the mouse, or frees it.
void page_capture(int is_captured);
/// Tells the page whether a field of a window has the keyboard.
void page_typing(int is_typing);
/// Loads the font of the windows. The page calls web_font() with its bytes, or with none if it has
/// no font.
void page_load_font(void);
/// Keeps the key of a world's server for later visits. Both are in hex.
void page_keep_server(const char* world, const char* key);
/// Stores a line with the hotbar and the tool of a world (in hex) for later visits.
void page_keep_kit(const char* world, const char* line);
/// Writes the line that page_keep_kit() has kept for a world, and a 0 behind it, to `out`, which
/// has `bytes` bytes. Writes an empty line if there is none, or if it is too long.
void page_read_kit(const char* world, char* out, int bytes);

/// Opens or closes the timeline.
void page_toggle_timeline(void);
/// Shows the newest edit, and the edit after which the world is shown. `is_past`: it is not the
/// live world.
void page_time(double newest, double shown, int is_past);

// The chunk cache, see WebCache. `world` is in hex. The page carries out the calls later, in their
// order.
/// Keeps the description of a world, a text.
void page_cache_enter(const char* world, const char* text);
/// Drops the rows of a world that CacheDrops names.
void page_cache_drop_rows(const char* world, int all, int edited, int lost, int tiles,
                          double common, std::uint32_t epoch);
/// Drops the row of a chunk or tile.
void page_cache_drop_row(const char* world, int level, int x, int y, int z);
/// Reads rows. `keys` has level, x, y and z of each. The page calls web_cache_found() for each row
/// that it has, and then web_cache_looked_up().
void page_cache_find(const char* world, const std::int32_t* keys, int count);
/// Writes rows. Each is a head, little-endian, and the bytes of the record:
///   u32 size of the record | i32 level, x, y, z | u32 epoch | f64 sequence
void page_cache_keep(const char* world, const std::uint8_t* rows, int bytes);

// The texture cache, see WebTextures. The page carries out the calls later, in their order.
/// Reads pictures. `hashes` has 32 bytes of each. The page calls web_texture_found() for each
/// picture that it has, and then web_textures_looked_up().
void page_textures_find(const std::uint8_t* hashes, int count);
/// Writes pictures. Each is its hash, a u32 with its size, little-endian, and its bytes.
void page_textures_keep(const std::uint8_t* rows, int bytes);
}
