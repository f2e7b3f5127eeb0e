// In the words of the oldest browsers: says what is missing where the page cannot compute.
(function () {
  var missing = "";
  var simd = [0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11];
  if (typeof WebAssembly !== "object") missing = "WebAssembly";
  else if (!WebAssembly.validate(new Uint8Array(simd))) missing = "the vector instructions of WebAssembly";
  else if (typeof Worker !== "function") missing = "workers";
  else if (typeof DecompressionStream !== "function") missing = "DecompressionStream";
  else if (typeof BigInt64Array !== "function") missing = "whole numbers of 64 bits";
  window.missing = missing;
  if (missing) {
    document.documentElement.className = "old";
    document.getElementById("lacking").innerHTML = missing;
  }
})();
