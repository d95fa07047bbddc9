-- Generates all blocks of a box, then shuts the server down. scripts/make-world installs this mod in
-- the world that it makes and names the box in the server's settings.
local box = core.settings:get("make_world_box"):split(",")
local first = vector.new(tonumber(box[1]), tonumber(box[2]), tonumber(box[3]))
local last = vector.new(tonumber(box[4]), tonumber(box[5]), tonumber(box[6]))

core.after(0, function()
  core.emerge_area(first, last, function(block, action, remaining)
    if action == core.EMERGE_CANCELLED or action == core.EMERGE_ERRORED then
      error("block " .. core.pos_to_string(block) .. " was not generated")
    end
    if remaining == 0 then
      core.request_shutdown()
    end
  end)
end)
