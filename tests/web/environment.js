// Ahead of each test program for Node.js: it sees the environment variables of the process.
Module["preRun"] = function () { Object.assign(ENV, process.env); };
