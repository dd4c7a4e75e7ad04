-- Armour units through the program, coarse: each has its shape's volume, and meshes without slivers.
local cdem = require "cdem"
local expect = require "expect"

local result = cdem.sweep{ script = "../../examples/armour_solids/case.lua", set = { { fineness = 8 } } }[1]
if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end

local figures = result.figures
for name, ratio in pairs{ accropode_slender = 0.34, accropode_stocky = 0.34, tetrapod = 0.28 } do
  expect.near(figures, name .. "_volume_ratio", ratio, 0.005)
end
expect.between(figures, "dolos_volume_ratio", 0.155, 0.165) -- 0.16 to its two digits
expect.near(figures, "antifer_volume_ratio", 1.0247, 1e-3)
expect.near(figures, "cube_volume_ratio", 1, 1e-9)
expect.near(figures, "slope_volume_m3", 48, 1e-9)
expect.near(figures, "cube_principal_inertia_ratio", 1, 1e-6)
expect.near(figures, "tetrapod_principal_inertia_ratio", 1, 1e-5)
for _, name in ipairs{ "accropode_slender", "accropode_stocky", "dolos", "tetrapod", "antifer", "cube" } do
  expect.between(figures, name .. "_min_radius_ratio", 0.15, 1)
end
expect.done()
