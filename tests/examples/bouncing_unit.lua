-- A coarse unit dropped from heights that double: it breaks, and nothing is lost of the energy.
local cdem = require "cdem"
local expect = require "expect"

local result = cdem.sweep{ script = "../../examples/bouncing_unit/case.lua", jobs = 1, set = { { fineness = 4, growth = 2 } } }[1]
if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
local figures = result.figures
-- At rho c v = T a bar that hits flat is stressed to its strength, and a corner that hits first far less of the unit: it
-- breaks later, but no later than at twenty times the velocity, where its kinetic energy is that of a block strained to
-- T all through four hundred times over.
local bar = 3e6 / (2500 * math.sqrt(30e9 / 2500))
expect.between(figures, "breaks_at_velocity_m_per_s", bar, 20 * bar)
expect.between(figures, "energy_balance_error", 0, 0.02)
expect.done()
