#pragma once
// How a report looks: colours of Okabe and Ito ("Color Universal Design", 2008), which colour-blind readers
// tell apart, on light or dark paper as the reader's system has it.

#include <string_view>

namespace obscura {

constexpr std::string_view report_style = R"(
:root{color-scheme:light dark;--paper:#fdfcf9;--panel:#f2f1ec;--ink:#1e2026;--soft:#54565c;--line:#d8d6cf;
--before:#8d8f94;--after:#0072b2;--zone:#009e73;--worst:#d55e00;--rms:#0072b2;--residual:#8d8f94}
@media (prefers-color-scheme:dark){:root{--paper:#16181c;--panel:#202329;--ink:#eceae4;--soft:#a9abb0;
--line:#363a42;--before:#8d8f94;--after:#56b4e9;--zone:#2bbd92;--worst:#f08a3c;--rms:#56b4e9;--residual:#a9abb0}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);
font:15px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,"Helvetica Neue",Arial,sans-serif}
main{max-width:1240px;margin:0 auto;padding:36px 28px 64px}
h1{font-size:30px;line-height:1.2;margin:0;overflow-wrap:anywhere}
h2{font-size:18px;margin:0 0 6px}
header p{margin:0;color:var(--soft)}
header .kind{letter-spacing:.06em;text-transform:uppercase;font-size:12px}
section{margin-top:34px;padding-top:22px;border-top:1px solid var(--line)}
.lead{margin:0 0 14px;color:var(--soft);max-width:80ch}
.tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(130px,1fr));gap:10px;margin-top:22px}
.tile{background:var(--panel);border-radius:6px;padding:12px 14px}
.tile b{display:block;font-size:21px;font-variant-numeric:tabular-nums}
.tile span{color:var(--soft);font-size:13px}
.pair{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(440px,100%),1fr));gap:18px;align-items:start}
figure{margin:0}
figure>img{display:block;width:100%;height:auto;border-radius:4px;background:var(--panel)}
figcaption{margin-top:6px;font-size:13px;color:var(--soft)}
table+figure{margin-top:18px;max-width:860px}
.scale{position:relative;max-width:640px;margin:18px auto 0}
.scale>img{display:block;width:100%;height:22px;border-radius:3px}
.numbers{position:relative;height:20px;font-size:12px;font-variant-numeric:tabular-nums}
.numbers span{position:absolute;transform:translateX(-50%)}
.ends{display:flex;justify-content:space-between;font-size:12px;color:var(--soft)}
table{border-collapse:collapse;width:100%;max-width:960px;font-size:14px}
th{text-align:left;font-weight:600;color:var(--soft);font-size:13px}
th,td{padding:6px 14px 6px 0;border-bottom:1px solid var(--line);vertical-align:top;overflow-wrap:anywhere}
.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
dl{display:grid;grid-template-columns:repeat(auto-fit,minmax(250px,1fr));gap:10px 24px;margin:0 0 18px}
dt{font-size:12px;color:var(--soft)}
dd{margin:0}
ul{margin:0;padding-left:20px}
li{max-width:110ch}
.faint{color:var(--soft)}
.bad{color:var(--worst)}
.keys{font-size:13px;margin:4px 0 0}
.key{display:inline-block;width:12px;height:12px;border-radius:2px;margin:0 7px 0 0;vertical-align:-1px}
.keys .key:not(:first-child),.keys .faint{margin-left:16px}
i.before{background:var(--before)}i.after{background:var(--after)}i.zone{background:var(--zone);opacity:.4}
svg{display:block;width:100%;max-width:860px;height:auto;font-family:inherit}
svg text{fill:var(--ink);font-size:12.5px;font-variant-numeric:tabular-nums}
svg text.faint{fill:var(--soft);font-size:11.5px}
svg line.grid{stroke:var(--line)}
svg line.axis{stroke:var(--ink)}
svg line.screen{stroke:var(--ink);stroke-dasharray:3 3}
svg .zone{fill:var(--zone);opacity:.14}
svg polygon.before{fill:var(--before);fill-opacity:.4;stroke:var(--before)}
svg polygon.after{fill:var(--after);fill-opacity:.28;stroke:var(--after);stroke-width:1.6}
svg rect.bar{fill:var(--after)}
svg .curve{fill:none;stroke-width:2}
svg .residual{stroke:var(--residual)}svg .worst{stroke:var(--worst)}svg .rms{stroke:var(--rms)}
svg .residual.dot{fill:var(--residual)}svg .worst.dot{fill:var(--worst)}svg .rms.dot{fill:var(--rms)}
svg .limit{stroke-dasharray:5 4;opacity:.8}
@media print{
:root{color-scheme:light;--paper:#fff;--panel:#f2f1ec;--ink:#1e2026;--soft:#54565c;--line:#d8d6cf;
--before:#8d8f94;--after:#0072b2;--zone:#009e73;--worst:#d55e00;--rms:#0072b2;--residual:#8d8f94}
main{max-width:none;padding:0}figure,tr,.tile{break-inside:avoid}h2{break-after:avoid}
.key{print-color-adjust:exact;-webkit-print-color-adjust:exact}}
)";

}  // namespace obscura
