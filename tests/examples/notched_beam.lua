-- Han 2010 example 4.2 through the program: the crack runs from the notch to the load. References: finite elements for
-- the beam with its end faces held, and the path of the largest hoop stress for the crack.
local cdem = require "cdem"
local expect = require "expect"

local results = cdem.sweep{ script = "../../examples/notched_beam/case.lua",
                            set = { { support = "pinned" }, { support = "face", passes = 0 },
                                    { support = "roller", passes = 0 } } }
for _, result in ipairs(results) do
  if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
end

local cracked, elastic, roller = results[1].figures, results[2].figures, results[3].figures
expect.near(elastic, "elastic_midspan_uy_m", -3.136e-4, 0.02)
expect.near(roller, "elastic_midspan_uy_m", -7.03e-4, 0.1) -- held along lines: drifts with any mesh
expect.between(cracked, "crack_tip_x_m", 0.57, 0.63) -- within 1.5 blocks of the load at 0.615
expect.between(cracked, "crack_tip_y_m", 0.2, 0.3)
expect.between(cracked, "path_rms_to_reference_m", 0, 0.06)
expect.between(cracked, "path_rms_to_hoop_stress_m", 0, 0.015) -- half a block
expect.between(cracked, "energy_balance_error", 0, 0.01)
expect.done()
