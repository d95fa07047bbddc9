// The functions by which the browser client writes to its page. page/bridge.js implements them. Texts
// are UTF-8 and may come from the server, so the page shows them as text, never as HTML. Thread: the
// page's only one.
#pragma once
#include <cstdint>

extern "C" {
/// Shows how far joining is. `share` is 0 to 1, or negative if it is not known. `detail` may be
/// empty.
void page_progress(const char* text, double share, const char* detail);
/// Takes the picture of joining away: there is ground to see.
void page_joined(void);
/// Shows a line about the state while playing, such as a lost connection. Empty: none.
void page_state(const char* text);
/// Ends the play, with a headline and the exact reason.
void page_failed(const char* headline, const char* detail);
/// Shows a text for some seconds.
void page_notice(const char* text, int is_warning);
/// Adds a line to the chat. `name` is empty unless a player wrote it.
void page_chat(const char* name, const char* text);
/// Opens the line in which the player types.
void page_open_chat(void);
/// Begins a new list of materials, and adds one. `colour` is 0xRRGGBB.
void page_clear_materials(void);
void page_material(int id, const char* name, std::uint32_t colour);
/// Opens or closes the list of materials.
void page_toggle_palette(void);
/// Sets a slot of the hotbar.
void page_slot(int slot, int material, int is_chosen);
/// Sets the number of other players, and their names, separated by line ends.
void page_players(int count, const char* names);
/// The player flies or walks.
void page_walking(int is_walking);
/// Keeps the key of a world's server for later visits. Both are in hex.
void page_keep_server(const char* world, const char* key);
}
