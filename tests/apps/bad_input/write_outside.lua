-- exit code: 2
-- says: io.open
-- says: /tmp/cdem_written_outside.txt
-- says: output folder

local file = assert(io.open("/tmp/cdem_written_outside.txt", "w")) -- wrong
file:write("caught")
file:close()
