-- A prism with one joint at 45 and 60 degrees, with coarse tetrahedra: blocks and mesh bear what Jaeger says.
local cdem = require "cdem"
local expect = require "expect"

local result = cdem.sweep{ script = "../../examples/jointed_prism/study.lua", set = { { size = 0.1, angles = {45.0, 60.0} } } }[1]
if result.exit_code ~= 0 then error("the example ended with exit code " .. result.exit_code) end
local figures = result.figures
for _, kind in ipairs{ "blocks", "mesh" } do expect.between(figures, kind .. "_worst_error", 0, 0.1) end
expect.done()
