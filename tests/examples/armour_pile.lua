-- A small pile through the program: twelve units laid in an armour layer, their first row held, come to rest where they
-- were laid, and a flow throws one out. A pile this small has next to no middle, so its density says little.
local cdem = require "cdem"
local expect = require "expect"

local example = "../../examples/armour_pile/"
local result = cdem.sweep{ script = example .. "settle.lua",
                           set = { { count = 12, columns = 3, held = 3, kinetic_energy_ratio = 1e-3, pictures = false } } }[1]
if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
local figures = result.figures
expect.between(figures, "settle_kinetic_ratio", 0, 1e-3)
expect.between(figures, "energy_balance_error", 0, 0.01)
expect.between(figures, "max_penetration_over_height", 0, 0.01)
expect.near(figures, "supports_carry_over_weight", 1, 0.01)
expect.between(figures, "contacts_per_unit", 2, 8)
expect.between(figures, "largest_way_over_height", 0, 0.1)

-- rho V^2 / 2 on a silhouette of H^2 carries a unit's weight under water up a frictionless slope of 1:1.5 at 3.1 m/s (a
-- little less, as limbs do not shield each other); on a third of it, with friction of 35 degrees, at 7.7 m/s, and nothing
-- but neighbours can hold one back beyond: with the whole highest row held all twelve are wedged, one of it is left free.
local run = cdem.sweep{ script = example .. "flow.lua",
                        set = { { pile = "../" .. result.output .. "/pile.json", held = 2, units = 1,
                                  first_velocity = 2, velocity_step = 1, longest_hold = 0.4, pictures = false } } }[1]
if run.exit_code ~= 0 then error("the flow ended with exit code " .. run.exit_code) end
expect.between(run.figures, "unit_1_leaves_at_m_per_s_5_t", 2.5, 15)
expect.between(run.figures, "energy_balance_error", 0, 0.01)
expect.between(run.figures, "max_penetration_over_height", 0, 0.01)
expect.done()
