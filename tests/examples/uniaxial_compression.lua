-- Han 2010 example 4.1 through the program, whole, and at 24 MPa, where nothing may happen. The references are the
-- finite-element values and the angles of the Mohr-Coulomb planes; the counts are those of an independent program.
local cdem = require "cdem"
local expect = require "expect"

local script = "../../examples/uniaxial_compression/case.lua"
local results = cdem.sweep{ script = script, set = { { pressure = 30e6 }, { pressure = 24e6 } }, jobs = 2 }

for _, result in ipairs(results) do
  if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
end

local failed, held = results[1].figures, results[2].figures
expect.near(failed, "elastic_top_uy_mean_m", -2.7375e-4, 0.02)
expect.near(failed, "elastic_side_ux_m", 4.665e-5, 0.01)
expect.equal(failed, "blocks_cut_first_pass", 56)
expect.between(failed, "cut_angle_min_deg", 29, 30)
expect.between(failed, "cut_angle_max_deg", 30, 33)
expect.between(failed, "wedge_ux_max_m", 0.4e-3, 0.6e-3)
expect.near(failed, "final_top_uy_mean_m", -5.06e-4, 0.1)
expect.between(failed, "mirror_error_ux", 0, 0.01)
expect.between(failed, "energy_balance_error", 0, 0.01)
expect.between(failed, "residual", 0, 1e-5)

expect.near(held, "elastic_top_uy_mean_m", -2.7375e-4 * 24 / 30, 0.02)
expect.equal(held, "blocks_cut_first_pass", 0)
expect.equal(held, "bonds_broken_tension", 0)
expect.equal(held, "bonds_broken_shear", 0)
-- A plate of 4 x 4 blocks falls apart as well, in a tenth of the time.
local fallen = cdem.sweep{ script = script, jobs = 1,
                           set = { { until_stage = "collapse", divisions = 4, collapse_duration = 0.15, film = false } } }[1]
if fallen.exit_code ~= 0 then error("the collapse ended with exit code " .. fallen.exit_code) end
expect.between(fallen.figures, "fallen_part", 0.01, 0.5)
expect.equal(fallen.figures, "blocks_below_the_floor", 0)
expect.between(fallen.figures, "energy_balance_error", 0, 0.01)
expect.done()
