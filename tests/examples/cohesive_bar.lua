-- The energy that separation takes is the fracture energy put in, whatever the curve and the blocks.
local cdem = require "cdem"
local expect = require "expect"

local script = "../../examples/cohesive_bar/case.lua"
local results = cdem.sweep{ script = script, jobs = 2, set = { { curves = {"linear"}, blocks = {1, 3} },
                                                               { curves = {"exponential"}, blocks = {1, 3} } } }
for i, curve in ipairs{ "linear", "exponential" } do
  if results[i].exit_code ~= 0 then error("the example ended with exit code " .. results[i].exit_code) end
  local figures = results[i].figures
  for _, n in ipairs{ 1, 3 } do
    expect.near(figures, string.format("opening_%s_%d_J_m2", curve, n), 100, 0.02)
    expect.near(figures, string.format("slip_%s_%d_J_m2", curve, n), 200, 0.02)
  end
  expect.between(figures, "energy_balance_error", 0, 1e-3)
end
expect.done()
