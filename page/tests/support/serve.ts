// The stand-in for `durer view`, to be looked at by hand: npx vite-node tests/support/serve.ts
import { whitted } from "./fixture";
import { Mock } from "./mock";

const mock = await new Mock(whitted()).start(Number(process.env["PORT"] ?? 0));
console.log(mock.address);
