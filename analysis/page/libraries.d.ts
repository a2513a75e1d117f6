// What the checker of types does not know of by itself.
declare module "d3-array";
declare module "d3-brush";
declare module "d3-drag";
declare module "d3-scale";
declare module "d3-selection";
declare const DecompressionStream: any;
interface Window { explorer: any; }
