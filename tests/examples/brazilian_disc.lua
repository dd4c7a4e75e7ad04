-- A coarse disc: the stress in its middle is that of the formula, and it splits when the middle bears the tensile strength.
local cdem = require "cdem"
local expect = require "expect"

local result = cdem.sweep{ script = "../../examples/brazilian_disc/case.lua",
                           set = { { size = 4e-3, fracture_energy = 40.0, speed = 0.2, pictures = false } } }[1]
if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
local across, along = 1 - 2 * math.sin(math.rad(10)) ^ 2, 3 - 2 * math.sin(math.rad(10)) ^ 2
expect.near(result.figures, "stress_across_over_2P_by_pi_D_t", across, 0.1)
expect.near(result.figures, "pressure_along_over_2P_by_pi_D_t", along, 0.08)
expect.near(result.figures, "strength_over_tensile_strength", 1, 0.15)
expect.between(result.figures, "energy_balance_error", 0, 0.01)
expect.done()
