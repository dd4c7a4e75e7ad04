-- A small pile through the program: twelve units laid in an armour layer, their first row held, come to rest where they
-- were laid. A pile this small has next to no middle, so its density says little.
local cdem = require "cdem"
local expect = require "expect"

local example = "../../examples/armour_pile/"
local result = cdem.sweep{ script = example .. "settle.lua",
                           set = { { count = 12, columns = 3, held = 3, kinetic_energy_ratio = 0.02, pictures = false } } }[1]
if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
local figures = result.figures
expect.between(figures, "settle_kinetic_ratio", 0, 0.02)
expect.between(figures, "energy_balance_error", 0, 0.01)
expect.between(figures, "contacts_per_unit", 1, 8)
expect.between(figures, "porosity", 0.3, 0.7)
expect.between(figures, "largest_way_over_height", 0, 0.5)
expect.done()
