local cdem = require "cdem"

-- example: cdem.report
cdem.report{ { name = "slip_m", value = 0.102, unit = "m", reference = 0.1, kind = "formula", source = "g t^2 / 2",
               tolerance = 0.05 } } -- report.md, report.json

-- example: cdem.write_csv cdem.read_csv
cdem.write_csv{ file = "curve.csv", columns = { { name = "time", values = {0, 1} }, { name = "load", values = {0, 5e3} } } }
local curve = cdem.read_csv("curve.csv")
print(curve.load[2]) -- 5000

-- example: cdem.log
cdem.log("half of it is done") -- to the terminal and to cdem.log

-- example: cdem.linspace
for _, angle in ipairs(cdem.linspace(20, 40, 5)) do print(angle) end -- 20 25 30 35 40

-- example: cdem.describe
print(cdem.describe{ size = {1, 2}, name = "a" })

-- example: cdem.elapsed
print(cdem.elapsed() .. " s since the run began")

-- example: cdem.sweep
local results = cdem.sweep{ script = "parameters.lua", set = { { pressure = 20e6 }, { pressure = 30e6 } } }
for _, result in ipairs(results) do print(result.set.pressure, result.exit_code, result.seconds) end
