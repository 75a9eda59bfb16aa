import { defineConfig } from "vite";

// where `npm run dev` finds a service that runs on this machine
const service = process.env.HOOKEAN_SERVICE ?? "http://127.0.0.1:8765";

export default defineConfig({
  base: "/page/",
  build: {
    outDir: "../server/hookean_server/page",
    emptyOutDir: true,
    sourcemap: false,
    target: "es2023",
    assetsInlineLimit: 0, // the service's content security policy allows files alone
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 1500, // kB: it comes from the machine it runs on
    license: { fileName: "licenses.md" },
  },
  server: {
    port: 5173,
    strictPort: true,
    // the service answers its own addresses alone, so its name and origin are what it is asked as
    proxy: {
      "^/(v1|problems|metrics)": {
        target: service,
        ws: true,
        changeOrigin: true,
        rewriteWsOrigin: true,
        headers: { origin: service },
      },
    },
  },
});
