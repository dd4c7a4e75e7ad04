-- Units in waves, shortened: two seconds of low waves on eight units. Nothing leaves its place, the water runs up the slope,
-- nothing passes through the ground, and the energy is kept. Units of ten times the usual strength stay whole in them.
local cdem = require "cdem"
local expect = require "expect"

local result = cdem.sweep{ script = "../../examples/armour_waves/case.lua",
                           set = { { units = 8, groups = 1, time = 2.0, pictures = false },
                                   { units = 8, groups = 1, time = 0.3, pictures = false, breakable = true,
                                     tensile_strength = 3e7, fracture_energy = 1e4 } } }
for _, run in ipairs(result) do
  if run.exit_code ~= 0 then error("the example ended with exit code " .. run.exit_code) end
end
expect.between(result[2].figures, "broken_share", 0, 0)
result = result[1]
expect.between(result.figures, "largest_movement_over_dn_ns_2.5", 0, 0.2)
expect.between(result.figures, "run_up", 0.5, 10)
expect.between(result.figures, "deepest_contact_over_height", 0, 0.01)
expect.between(result.figures, "energy_balance_error", 0, 0.01)
expect.done()
