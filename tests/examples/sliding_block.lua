-- Friction on an incline: sticks below the friction angle, slides with the formula's acceleration above it.
local cdem = require "cdem"
local expect = require "expect"

local g, phi = 9.81, math.rad(30)
local result = cdem.sweep{ script = "../../examples/sliding_block/case.lua", jobs = 1, set = { { size = 1.0 } } }[1]
if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
local figures = result.figures
expect.between(figures, "acceleration_at_25_degrees_m_per_s2", -1e-3, 1e-3)
for _, angle in ipairs{ 32, 35, 40, 50 } do
  local a = math.rad(angle)
  expect.near(figures, "acceleration_at_" .. angle .. "_degrees_m_per_s2",
              g * (math.sin(a) - math.tan(phi) * math.cos(a)), 0.005)
end
expect.between(figures, "energy_balance_error", 0, 0.01)
expect.done()
