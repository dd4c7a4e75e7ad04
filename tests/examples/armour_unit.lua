-- One set-up of the armour unit through the program: its first bonds break when beam theory says, and it breaks at the
-- root, near which the bending moment is largest, and at a higher velocity by ramp, in which inertia carries a part, than
-- by hold.
local cdem = require "cdem"
local expect = require "expect"

local example = "../../examples/armour_unit/"
local results = cdem.sweep{ script = example .. "case.lua",
                            set = { { fineness = 4.0 }, { fineness = 10.0, mode = "hold", pictures = false } } }
for _, result in ipairs(results) do
  if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
end
local figures, finer = results[1].figures, results[2].figures
-- Beam theory at the root, 12.9 m/s. The stress there goes by the velocity squared: a tenth of the velocity leaves a fifth
-- of the stress for what beam theory leaves out, the notch where a leg meets the body (unbroken meshes show from 3 % less to
-- 22 % more than M / W there, the finer the more) and the mean over a face of the mesh. That is for 3103 tetrahedra; 833
-- see the velocity only to a third.
expect.near(finer, "case_1_first_break_hold_m_per_s", 12.9, 0.1)
expect.between(finer, "case_1_hold_m_per_s", finer.case_1_first_break_hold_m_per_s, 1.5 * 12.9)
expect.between(figures, "case_1_ramp_m_per_s", figures.case_1_hold_m_per_s, 40)
expect.between(figures, "case_1_hold_height_fraction", 0, 1 / 3)
expect.between(figures, "principal_inertia_ratio_max", 1, 3)
expect.between(figures, "energy_balance_error", 0, 1e-4)
expect.done()
